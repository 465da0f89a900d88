"""Records of a run: rows of metrics.jsonl, the line about a result, values as JSON holds them.

`metrics` are arrays [rounds, S], `episode/...` [rounds, S, E]; a round is one decision in each
of E worlds of each of S learners. Rows that are made of them have the number of a learner, and its
seed in a file.
"""

import json
import math
from collections.abc import Mapping
from types import NoneType
from typing import Any

import numpy as np

Metrics = dict[str, np.ndarray]
Sums = dict[str, np.ndarray]  # name -> [2, S] sum and number of the values of each learner
ACTION = "world/action"
Row = dict[str, Any]
COORDINATES = ("step", "seed", "wall_s")  # of a row; every other name but WORD is a metric
WORD = "diverged"  # of a row: the only value that is no number
Number = int | float | NoneType


def row_of(line: bytes) -> Row | None:
    """The row in a line of metrics.jsonl; None for anything else."""
    try:
        row = json.loads(line)
        whole = type(row["step"]) is type(row["seed"]) is int
        numbers = (value for name, value in row.items() if name != WORD)
        sound = whole and "wall_s" in row and all(isinstance(v, Number) for v in numbers)
    except (ValueError, TypeError, LookupError):
        return None
    return row if sound else None


def result_line(summary: Mapping[str, Any]) -> str:
    """The last evaluation and training return, with their means over seeds."""
    parts = []
    for name, each in (("evaluation", "final_eval"), ("training return", "final_return")):
        known = [value for value in summary.get(each) or () if value is not None]
        text = f"{sum(known) / len(known):,.1f}" if known else "none yet"
        if known and each == "final_return":
            text += " over the last tenth"  # the rows above have that of the last episode
        if len(known) > 1:
            text += f" (mean of {len(known)} seeds)"
        parts.append(f"{name} {text}")
    return "; ".join(parts)


def flatten_keys(node: Mapping[str, Any], where: str = "") -> dict[str, Any]:
    """The values of a tree by their full keys."""
    values: dict[str, Any] = {}
    for key, value in node.items():
        if isinstance(value, Mapping) and value:
            values |= flatten_keys(value, f"{where}{key}.")
        else:
            values[f"{where}{key}"] = value
    return values


def json_value(value: Any) -> Any:
    """A value as JSON holds it: arrays are lists, numbers that are not finite are null."""
    if isinstance(value, dict):
        return {str(name): json_value(each) for name, each in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return json_value(value.tolist())
    if isinstance(value, list | tuple):
        return [json_value(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def arrays(value: Any) -> Any:
    """A value from JSON with lists of numbers as arrays, and null in them as NaN."""
    if isinstance(value, dict):
        return {name: arrays(each) for name, each in value.items()}
    if not isinstance(value, list):
        return value
    try:
        return np.array(value, float)
    except (TypeError, ValueError):
        return [arrays(each) for each in value]


def added(sums: Sums, metrics: Metrics) -> Sums:
    """The sums since the last row of means with the next rounds, but of `episode/...`.

    NaN is left out. One round is added after another, so the sums do not depend on where the calls
    of the program end.
    """
    total = {}
    for name, m in metrics.items():
        if not name.startswith("episode/"):
            known = ~np.isnan(m)
            values = np.array((np.where(known, m, 0), known), np.float64)  # [2, rounds, S]
            begun = sums.get(name, np.zeros_like(values[:, 0]))
            both = np.concatenate((begun[:, None], values), axis=1)
            total[name] = np.cumsum(both, axis=1)[:, -1]
    return total


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


def episodes(metrics: Metrics, start: int, worlds: int) -> list[Row]:
    """A row per episode that ended in the rounds after `start`."""
    return [
        {
            "step": start + (int(i) + 1) * worlds,
            "learner": int(s),
            "train/return": metrics["episode/return"][i, s, e],
            "train/length": int(metrics["episode/length"][i, s, e]),
        }
        for i, s, e in np.argwhere(metrics["episode/done"])
    ]


def means(sums: Sums, learners: int, end: int) -> list[Row]:
    """A row of means per learner, without names that have no values."""
    return [
        {"step": end, "learner": s}
        | {name: total[s] / count[s] for name, (total, count) in sums.items() if count[s]}
        for s in range(learners)
    ]
