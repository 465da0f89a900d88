"""The results of runs as an entry of docs/results/community.md, a file that others may write, too.

    {"name": METHOD, "link": URL, "machine": TEXT, "rows": [
        {"task": NAME, "steps": decisions, "seeds": [S], "returns": [S], "decisions_per_s": RATE}]}

returns: the evaluation return of each seed at `steps`, undiscounted and without exploration.
decisions_per_s: in training, of all seeds of a run together; null where it was not measured.
"""

import json
from collections.abc import Sequence
from typing import Any

import numpy as np

from hybrid_rl import Curve, RunFolder, UsageError, curves

RETURN = "eval/return"
KEYS = ("name", "link", "machine", "rows")
ROW = ("task", "steps", "seeds", "returns", "decisions_per_s")


def entry(runs: Sequence[RunFolder]) -> str:
    """The text of an entry: a row for each task, at the last decision that all its seeds have.

    Its name is the method's, its link is empty: both are for the author to write.
    """
    drawn = curves([run.path for run in runs], RETURN)
    _one("methods", [curve.label for curve in drawn])
    machine = _one("machines", [run.summary.get("device") or "unknown" for run in runs])
    rows = [_row(curve, runs) for curve in drawn]
    made = {"name": drawn[0].label, "link": "", "machine": machine, "rows": rows}
    return json.dumps(made, indent=1) + "\n"


def _row(curve: Curve, runs: Sequence[RunFolder]) -> dict[str, Any]:
    at = np.flatnonzero(curve.shared)
    if not len(at):
        raise UsageError(f"{curve.task}, {curve.label}: no evaluation that all its seeds have")
    speeds = [run.summary.get("env_steps_per_s") for run in runs if str(run.path) in curve.runs]
    known = [speed for speed in speeds if speed]
    return {
        "task": curve.task,
        "steps": int(curve.x[at[-1]]),
        "seeds": list(curve.seeds),
        "returns": [round(float(value), 1) for value in curve.each[:, at[-1]]],
        "decisions_per_s": round(float(np.median(known)), 1) if known else None,
    }


def _one(what: str, names: Sequence[str]) -> str:
    """The only name there is."""
    found = sorted(set(names))
    if len(found) > 1:
        raise UsageError(f"an entry is of one method on one machine; {what}: {', '.join(found)}")
    return found[0]
