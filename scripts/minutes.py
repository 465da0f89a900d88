"""Return over minutes from the command: the numbers and the picture of docs/results/minutes.md.

    python -m scripts.minutes runs=FOLDER out=minutes.png

Runs are the folders FOLDER/ROBOT/METHOD/NAME; FOLDER/ROBOT/METHOD/NAME.json is of scripts.ppo_brax.
The time of an evaluation is `before_s` of summary.json and its `wall_s`, so that imports and the
compiler count. Learners of one program wait for each other: if METHOD has runs of one learner, too,
these are the clock of all, at each number of decisions; beyond their end by the rate of their last
half. After a minute a learner has the return of its latest evaluation, null once its run is over.
"""

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.analysis import learning_curves
from hybrid_rl.analysis.curves import curve_of, spread
from hybrid_rl.analysis.logged import Learner, count_failures, learners
from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.analysis.studies import save
from hybrid_rl.cli.arguments import Argument, output, read

ARGUMENTS = (
    Argument("runs", "", "folder of the runs, by robot and method", needed="runs=FOLDER"),
    Argument("out", "minutes.png", "the picture; its numbers are beside it, as .json"),
)
METRIC, MINUTES = "eval/return", (1, 2, 5, 10)
Clock = Callable[[np.ndarray], np.ndarray]  # decisions [N] -> [s] since the command


def evaluated(path: Path) -> list[tuple[Learner, Learner]]:
    """Each learner's evaluations over seconds since the command, and over decisions."""
    if path.suffix == ".json":
        rows = json.loads(path.read_text(encoding="utf-8"))["rows"]
        each = [
            [np.array([row[key] for row in own], float) for key in ("s", "step", "return")]
            for own in rows.values()
        ]
        pairs = zip(map(int, rows), each, strict=True)
        return [(Learner(path, s, t, y), Learner(path, s, x, y)) for s, (t, x, y) in pairs]
    run = RunFolder(path)
    before = run.summary["before_s"]
    timed, counted = (learners(run, METRIC, x) for x in ("wall_s", "step"))
    timed = [replace(each, x=each.x + before, ended=each.ended + before) for each in timed]
    return [*zip(timed, counted, strict=True)]


def clock(alone: Sequence[tuple[Learner, Learner]]) -> Clock:
    """The mean clock of learners that had a program of their own."""

    def seconds(decisions: np.ndarray) -> np.ndarray:
        found = []
        for timed, counted in alone:
            x, t = counted.x, timed.x
            half = len(x) // 2
            slope = (t[-1] - t[half]) / (x[-1] - x[half])
            later = t[-1] + slope * (decisions - x[-1])
            found.append(np.where(decisions > x[-1], later, np.interp(decisions, x, t)))
        return np.mean(found, axis=0)

    return seconds


def members(folder: Path) -> list[Learner]:
    """The learners of a method, over seconds since the command."""
    files = {*folder.glob("*.json"), *(path.parent for path in folder.rglob("summary.json"))}
    runs = [evaluated(path) for path in sorted(files)]
    alone = [run[0] for run in runs if len(run) == 1 and len(run[0][0].x) > 2]
    shared = [counted for run in runs if len(run) > 1 for _, counted in run]
    if not (alone and shared):
        return [timed for run in runs for timed, _ in run]
    time = clock(alone)
    return [
        replace(each, x=time(each.x), ended=float(time(np.array(each.ended)))) for each in shared
    ]


def after(learner: Learner, minutes: float) -> float:
    """The latest evaluation at that time; NaN before the first, and once the run is over."""
    x, t = learner.x, 60 * minutes
    if not len(x) or not x[0] <= t <= x[-1] + np.diff(x).max(initial=0):
        return np.nan
    return float(learner.y[np.searchsorted(x, t, side="right") - 1])


def numbers(folder: Path) -> dict[str, Any]:
    """Curves of all methods, and the returns [S] after MINUTES."""
    found: dict[str, Any] = {"metric": METRIC, "x": "wall_s", "minutes": {}, "curves": []}
    for robot in sorted(path for path in folder.iterdir() if path.is_dir()):
        methods = sorted(path for path in robot.iterdir() if path.is_dir())
        panel = {(robot.name, path.name): members(path) for path in methods}
        rows = found["minutes"][robot.name] = {}
        for key, (each, notes) in count_failures(METRIC, panel).items():
            rows[key[1]] = {str(m): [after(one, m) for one in each] for m in MINUTES}
            curve = curve_of(key, METRIC, each, 0.0, notes)
            found["curves"].append(learning_curves.to_numbers(curve))
    return found


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    found = numbers(Path(given["runs"]))
    drawn = learning_curves.from_numbers(found)
    save(learning_curves.plot(drawn, "wall_s"), found, output("out", given["out"], (".png",)))
    for robot, methods in found["minutes"].items():
        for method, rows in methods.items():
            known = {m: np.array(row) for m, row in rows.items() if np.isfinite(row).all()}
            ends = ", ".join(f"{m} min {spread(row)}" for m, row in known.items())
            print(f"{robot}, {method}: {ends}")


if __name__ == "__main__":
    main()
