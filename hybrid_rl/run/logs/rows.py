"""From the metrics of decisions to rows of metrics.jsonl.

`metrics` are arrays [rounds, S], `episode/...` [rounds, S, E]; a round is one decision in each
of E worlds of each of S learners. Rows have the number of a learner here, and its seed in a file.
"""

from collections.abc import Container, Mapping
from typing import Any

import numpy as np

from hybrid_rl.run.logs.records import Row

Metrics = dict[str, np.ndarray]
ACTION = "world/action"


def appended(gathered: Metrics, metrics: Metrics) -> Metrics:
    """The metrics since the last row of means with those of the next rounds, but `episode/...`."""
    new = {name: m for name, m in metrics.items() if not name.startswith("episode/")}
    return {n: np.concatenate([gathered[n], m]) for n, m in new.items()} if gathered else new


def infinite(metrics: Metrics, start: int, worlds: int) -> dict[int, tuple[int, str]]:
    """Learner -> (step, name) of its earliest infinite entry; the metrics begin after `start`.

    Numbers of the world come first, and only where its action was finite: what learns from them is
    infinite at the same step.
    """
    first: dict[int, tuple[int, str]] = {}
    given = np.isfinite(metrics[ACTION]) if ACTION in metrics else np.True_
    for name in sorted(metrics, key=lambda name: not of_world(name)):
        if name.startswith("episode/"):
            continue
        bad = np.isinf(metrics[name])
        for i, s in np.argwhere(bad & given if of_world(name) else bad):
            step = start + (int(i) + 1) * worlds
            if s not in first or step < first[s][0]:
                first[int(s)] = step, name
    return first


def of_world(name: str) -> bool:
    """True if a metric is a number that a world returns."""
    return name.startswith("world/") and name != ACTION


def episodes(
    metrics: Metrics, start: int, worlds: int, ended: Mapping[int, Mapping[str, Any]]
) -> list[Row]:
    """A row per episode that ended in the rounds after `start`.

    ended: learner -> where it diverged, with "step"; it has no rows from there on.
    """
    return [
        {
            "step": step,
            "learner": int(s),
            "train/return": metrics["episode/return"][i, s, e],
            "train/length": int(metrics["episode/length"][i, s, e]),
        }
        for i, s, e in np.argwhere(metrics["episode/done"])
        if (step := start + (int(i) + 1) * worlds) < ended.get(int(s), {}).get("step", np.inf)
    ]


def means(metrics: Metrics, learners: int, end: int, ended: Container[int] = ()) -> list[Row]:
    """A row of means per learner; NaN is left out, and a name with nothing else.

    ended: learners that diverged, which have no row.
    """
    averages = []
    for s in range(learners):
        if s in ended:
            continue
        row: Row = {"step": end, "learner": s}
        for name, values in metrics.items():
            known = values[:, s][~np.isnan(values[:, s])]
            if known.size:
                row[name] = known.mean(dtype=np.float64)
        averages.append(row)
    return averages
