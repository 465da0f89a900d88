"""From the metrics of a stride of decisions to rows of metrics.jsonl."""

from typing import Any

import numpy as np

Metrics = dict[str, np.ndarray]


class Diverged(ArithmeticError):
    """A learner reached NaN or infinity; one line names seed, step and quantity."""


def check(metrics: Metrics, seeds: tuple[int, ...], step: int, num_envs: int) -> None:
    """Raise Diverged at the first infinite entry; metrics [rounds, S] begin after `step`."""
    first: tuple[int, int, str] | None = None
    for name, values in metrics.items():
        if name.startswith("episode/"):
            continue
        for i, s in np.argwhere(np.isinf(values))[:1]:
            if first is None or i < first[0]:
                first = (int(i), int(s), name)
    if first is not None:
        i, s, name = first
        raise Diverged(f"seed {seeds[s]}, step {step + (i + 1) * num_envs}: {name} is not finite")


def rows(
    metrics: Metrics, seeds: tuple[int, ...], step: int, num_envs: int, wall_s: float
) -> list[dict[str, Any]]:
    """A row per finished episode, then one of means per seed.

    metrics [rounds, S] (`episode/...` [rounds, S, E]) begin after `step` decisions.
    """
    done = metrics["episode/done"]
    found = [
        {
            "step": step + (int(i) + 1) * num_envs,
            "seed": seeds[s],
            "wall_s": wall_s,
            "train/return": metrics["episode/return"][i, s, e],
            "train/length": int(metrics["episode/length"][i, s, e]),
        }
        for i, s, e in np.argwhere(done)
    ]
    end = step + done.shape[0] * num_envs
    for s, seed in enumerate(seeds):
        row = {"step": end, "seed": seed, "wall_s": wall_s}
        for name, values in metrics.items():
            told = values[:, s][~np.isnan(values[:, s])] if values.ndim == 2 else []
            if len(told):
                row[name] = told.mean(dtype=np.float64)
        found.append(row)
    return found
