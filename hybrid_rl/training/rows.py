"""From the metrics of a stride of decisions to rows of metrics.jsonl.

`metrics` are arrays [rounds, S], `episode/...` [rounds, S, E]; a round is one decision in each
of E worlds of each of S learners.
"""

from typing import Any

import numpy as np

Metrics = dict[str, np.ndarray]
Row = dict[str, Any]


class DivergenceError(ArithmeticError):
    """A learner reached NaN or infinity; one line names seed, step and quantity."""


def check(metrics: Metrics, seeds: tuple[int, ...], start: int, worlds: int) -> None:
    """Raise DivergenceError at the earliest infinite entry; the stride begins after `start`."""
    first: tuple[int, int, str] | None = None
    for name, values in metrics.items():
        if name.startswith("episode/"):
            continue
        for i, s in np.argwhere(np.isinf(values))[:1]:
            if first is None or i < first[0]:
                first = (int(i), int(s), name)
    if first is not None:
        i, s, name = first
        raise DivergenceError(
            f"seed {seeds[s]}, step {start + (i + 1) * worlds}: {name} is not finite"
        )


def episodes(metrics: Metrics, seeds: tuple[int, ...], start: int, worlds: int) -> list[Row]:
    """A row per episode that ended in the stride, which begins after `start`."""
    return [
        {
            "step": start + (int(i) + 1) * worlds,
            "seed": seeds[s],
            "train/return": metrics["episode/return"][i, s, e],
            "train/length": int(metrics["episode/length"][i, s, e]),
        }
        for i, s, e in np.argwhere(metrics["episode/done"])
    ]


def means(metrics: Metrics, seeds: tuple[int, ...], end: int) -> list[Row]:
    """A row of means per seed; NaN is left out, and a name with nothing else."""
    found = []
    for s, seed in enumerate(seeds):
        row: Row = {"step": end, "seed": seed}
        for name, values in metrics.items():
            if not name.startswith("episode/"):
                told = values[:, s][~np.isnan(values[:, s])]
                row |= {name: told.mean(dtype=np.float64)} if told.size else {}
        found.append(row)
    return found
