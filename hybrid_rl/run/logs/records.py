"""Records of a run, as they are read back: rows of metrics.jsonl, and summary.json.

A line or a value that training does not write is damage, and is found here.
"""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from types import NoneType
from typing import Any

import numpy as np

from hybrid_rl.errors import UsageError
from hybrid_rl.run.files.reading import from_json, json_file

Row = dict[str, Any]
COORDINATES = ("step", "seed", "wall_s")  # of a row; every other name but WORD is a metric
END = ("seed", "step", "quantity")
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


def summary_of(file: Path) -> dict[str, Any]:
    """The contents of summary.json."""
    values = json_file(file)
    if wrong := [key for key in SUMMARY if key in values and not SUMMARY[key](values[key])]:
        raise UsageError(f"{file}: {wrong[0]} is not what training writes")
    return values


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


def _number(value: Any) -> bool:
    return type(value) in (int, float) and abs(value) < LARGE and math.isfinite(value)


def _maybe(value: Any) -> bool:
    return value is None or _number(value)


def _all(each: Callable[[Any], bool]) -> Callable[[Any], bool]:
    """True if a value is null, or a list of what `each` accepts."""
    return lambda value: value is None or (isinstance(value, list) and all(map(each, value)))


def _end(value: Any) -> bool:
    """True if a value says where a learner diverged."""
    return isinstance(value, dict) and _number(value.get("step")) and {*END} <= {*value}


SUMMARY = {  # key -> whether a value is one that training writes
    **dict.fromkeys(("total_steps", "wall_s", "env_steps_per_s"), _maybe),
    **dict.fromkeys(("final_eval", "final_return"), _all(_maybe)),
    "seeds": lambda value: isinstance(value, list) and all(type(each) is int for each in value),
    "diverged": _all(_end),
    "versions": lambda value: isinstance(value, dict),
    "git_commit": lambda value: isinstance(value, (str, NoneType)),
}


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
