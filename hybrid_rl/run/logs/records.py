"""The rows of metrics.jsonl as they are read back, and the values of a run by their full keys."""

import math
from collections.abc import Mapping
from types import NoneType
from typing import Any

import numpy as np

from hybrid_rl.run.files.reading import from_json

Row = dict[str, Any]
COORDINATES = ("step", "seed", "wall_s")  # of a row; every other name but WORD is a metric
WORD = "diverged"  # of a row: the only value that is no number
LARGE = 2**63  # no whole number of a row is as large


def row_of(line: bytes) -> Row | None:
    """The row in a line of metrics.jsonl; None for anything else."""
    try:
        row = from_json(line)
        step, seed, wall = (row[name] for name in COORDINATES)
    except (ValueError, TypeError, LookupError):
        return None
    whole = [each for each in row.values() if type(each) is int]
    sound = (
        type(step) is type(seed) is int
        and min(step, seed) >= 0
        and _number(wall)
        and all(
            isinstance(each, (int, float, NoneType)) for name, each in row.items() if name != WORD
        )
        and all(abs(each) < LARGE for each in whole)
    )
    return row if sound else None


def _number(value: Any) -> bool:
    return type(value) in (int, float) and abs(value) < LARGE and math.isfinite(value)


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
