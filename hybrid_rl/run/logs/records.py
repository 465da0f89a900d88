"""Records of a run: rows of metrics.jsonl, the line about a result, values as JSON holds them."""

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import NoneType
from typing import Any, NamedTuple

import numpy as np

Row = dict[str, Any]
COORDINATES = ("step", "seed", "wall_s")  # of a row; every other name but WORD is a metric
WORD = "diverged"  # of a row: the only value that is no number
Number = int | float | NoneType


class Begun(NamedTuple):
    """A run whose rows are to come."""

    folder: Path
    seeds: Sequence[int]
    config: dict[str, Any]
    step: int | None = None  # from which it is resumed


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


def changes(then: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """Lines "KEY was A and is B", by full keys.

    A part occurs several times in a configuration: its shortest key names a change.
    """
    changed: dict[str, str] = {}
    for key in sorted({*now, *then}, key=lambda key: (key.count("."), key)):
        before, after = then.get(key, "absent"), now.get(key, "absent")
        if before != after:
            line = f"was {before} and is {after}"
            changed.setdefault(f"{key.rpartition('.')[2]} {line}", f"{key} {line}")
    return list(changed.values())


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
