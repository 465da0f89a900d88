"""docs/results/community.md: a table of docs/results/community/*.json, which anyone may extend.

`python -m hybrid_rl.report run=DIR out=FILE.json` writes such a file, whose form stands in
hybrid_rl.tools.report.entry. In place of `returns` and `decisions_per_s` a path of values.py may
stand, to numbers that are in docs/results already.
"""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.tools.report.entry import KEYS, ROW
from scripts.pages.values import RESULTS, at, band

FOLDER = RESULTS / "community"
HEAD = ("method", "seeds", "return", "decisions/s", "machine")


def read(path: Path) -> dict[str, Any]:
    """The entry in a file."""
    try:
        entry = json.loads(path.read_text(encoding="utf-8"))
        for row in _checked(entry):
            row["returns"] = np.atleast_1d(_numbers(row["returns"]))
            row["decisions_per_s"] = _numbers(row["decisions_per_s"])
            _check_row(row)
        return entry
    except (LookupError, TypeError, AttributeError, ValueError, OSError) as error:
        raise ValueError(f"{path.name}: {error}") from error


def _numbers(value: Any) -> Any:
    return at(value) if isinstance(value, str) else value


def _checked(entry: dict[str, Any]) -> list[dict[str, Any]]:
    if sorted(entry) != sorted(KEYS):
        raise ValueError(f"its keys must be {', '.join(KEYS)}")
    for key in KEYS[:-1]:
        if not (isinstance(entry[key], str) and entry[key].strip()) or set("|\n") & {*entry[key]}:
            raise ValueError(f"{key}: must be a text of one line, without |")
    link = entry["link"]
    there = (FOLDER / link.partition("#")[0]).is_file()
    if not (there or re.fullmatch(r"https://[\w-]+(\.[\w-]+)+(/[^\s)]*)?", link)):
        raise ValueError(f"link={link}: must be https://... or a file from {FOLDER.name}/")
    if not entry["rows"]:
        raise ValueError("rows: must have one at least")
    return entry["rows"]


def _check_row(row: dict[str, Any]) -> None:
    if sorted(row) != sorted(ROW):
        raise ValueError(f"the keys of a row must be {', '.join(ROW)}")
    if not re.fullmatch(r"[\w./-]+", row["task"]):
        raise ValueError(f"task={row['task']}: must be the name of a task or an environment")
    if not (isinstance(row["steps"], int) and row["steps"] > 0):
        raise ValueError(f"steps={row['steps']}: must be a number of decisions")
    if len(row["seeds"]) != len({*row["seeds"]}) or len(row["seeds"]) != len(row["returns"]):
        raise ValueError(f"{row['task']}: one return for each seed, and each seed once")
    if not np.isfinite(row["returns"].astype(float)).all():
        raise ValueError(f"{row['task']}: a return that is not finite")
    speed = row["decisions_per_s"]
    if speed is not None and not speed > 0:
        raise ValueError(f"decisions_per_s={speed}: must be above 0, or null")


def table() -> str:
    """A row for each method, task and number of decisions; the best return of a task first."""
    lines = []
    for path in sorted(FOLDER.glob("*.json")):
        entry = read(path)
        lines += [(row["task"], row["steps"], entry, row) for row in entry["rows"]]
    lines.sort(key=lambda line: (line[0].lower(), line[1], -band(line[3]["returns"])[0]))
    rows = [f"| task, decisions | {' | '.join(HEAD)} |", "|" + "---|" * (len(HEAD) + 1)]
    before = ""
    for task, steps, entry, row in lines:
        head = f"{task}, {steps:,}"
        rows.append(f"| {head if head != before else ''} | {_cells(entry, row)} |")
        before = head
    return "\n".join(rows) + "\n"


def _cells(entry: dict[str, Any], row: dict[str, Any]) -> str:
    middle, low, high = band(row["returns"])
    count, speed = len(row["seeds"]), row["decisions_per_s"]
    link = entry["link"]
    if not link.startswith("https:"):  # from the page, a folder above the file
        link = link.removeprefix("../")
    returned = f"{middle:,.0f} [{low:,.0f}, {high:,.0f}]" if count > 1 else f"{middle:,.0f}"
    fast = f"{speed:,.0f}" if speed else ""
    return " | ".join((f"[{entry['name']}]({link})", str(count), returned, fast, entry["machine"]))
