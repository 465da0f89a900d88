"""Return over minutes from the command: the numbers and the picture of docs/results/minutes.md.

    python -m scripts.minutes runs=FOLDER out=minutes.png
    python -m scripts.minutes runs=FOLDER keep=docs/results/minutes.json  # with what FOLDER lacks
    python -m scripts.minutes keep=docs/results/minutes.json  # draws it again

Runs are the folders FOLDER/ROBOT/METHOD/NAME; FOLDER/ROBOT/METHOD/NAME.json is of scripts.ppo_brax.
The time of an evaluation is `before_s` of summary.json and its `wall_s`, so that imports and the
compiler count. Learners of one program wait for each other: if METHOD has runs of one learner, too,
these are the clock of all, at each number of decisions; beyond their end by the rate of their last
half. After a minute a learner has the return of its latest evaluation, null once its run is over.
"""

import json
from collections.abc import Callable, Sequence
from contextlib import chdir
from dataclasses import replace
from functools import reduce
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hybrid_rl.analysis import learning_curves, studies, style
from hybrid_rl.analysis.curves import Curve, curve_of, spread
from hybrid_rl.analysis.logged import Learner, count_failures, learners
from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.cli.arguments import Argument, output, read
from hybrid_rl.errors import UsageError
from hybrid_rl.files.reading import json_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ARGUMENTS = (
    Argument("runs", "", "folder of the runs, by robot and method"),
    Argument("keep", "", "earlier numbers: each robot's methods that the runs lack are kept"),
    Argument("out", "minutes.png", "the picture; its numbers are beside it, as .json"),
)
ROBOTS = {  # its folder -> the title of its panel, in their order
    "halfcheetah": "half-cheetah",
    "walker2d": "walker",
    "ant": "ant",
    "humanoid": "humanoid",
    "legs": "Go1 follows commands",
}
METHODS = {  # its folder -> what one types, in their order
    "quick": "settings=quick",
    "sac": "algo=sac settings=quick",
    "flash_sac": "algo=flash_sac settings=quick",
    "ppo": "algo=ppo",
}
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


def members(folder: Path) -> list[tuple[Learner, Learner]]:
    """The learners of a method, over seconds since the command, and over decisions."""
    files = {*folder.glob("*.json"), *(path.parent for path in folder.rglob("summary.json"))}
    runs = [evaluated(path) for path in sorted(files)]
    alone = [run[0] for run in runs if len(run) == 1 and len(run[0][0].x) > 2]
    shared = [counted for run in runs if len(run) > 1 for _, counted in run]
    if not (alone and shared):
        return [both for run in runs for both in run]
    time = clock(alone)
    timed = [
        replace(each, x=time(each.x), ended=float(time(np.array(each.ended)))) for each in shared
    ]
    return [*zip(timed, shared, strict=True)]


def by_decisions(each: Sequence[tuple[Learner, Learner]]) -> dict[str, dict[str, Any]]:
    """After as many decisions as all evaluated at: returns [S], mean seconds since the command."""
    at = [dict(zip(c.x, zip(t.x, t.y, strict=True), strict=True)) for t, c in each]
    common = sorted(set.intersection(*({*found} for found in at))) if at else []
    both = {f"{n:,.0f}": [*zip(*(found[n] for found in at), strict=True)] for n in common}
    return {
        "returns": {n: [*y] for n, (_, y) in both.items()},
        "seconds": {n: float(np.mean(t)) for n, (t, _) in both.items()},
    }


def after(learner: Learner, minutes: float) -> float:
    """The latest evaluation at that time; NaN before the first, and once the run is over."""
    x, t = learner.x, 60 * minutes
    if not len(x) or not x[0] <= t <= x[-1] + np.diff(x).max(initial=0):
        return np.nan
    return float(learner.y[np.searchsorted(x, t, side="right") - 1])


def alone(folder: Path) -> dict[str, Any]:
    """What the first run of one learner in a method's folder took; {} if there is none."""
    for path in sorted(file.parent for file in folder.rglob("summary.json")):
        if len(run := evaluated(path)) == 1:
            timed, counted = run[0]
            rows, took = np.stack((timed.x, counted.x, timed.y), axis=1), RunFolder(path).summary
            kept = {key: took.get(key) for key in ("before_s", "compile_s")}
            return {**kept, "decisions_per_s": took.get("env_steps_per_s"), "evaluations": rows}
    return {}


def numbers(folder: Path) -> dict[str, Any]:
    """Curves of all methods, the returns [S] after MINUTES and decisions, and runs of one learner.

    evaluations of these: [s] since the command, decisions, return.
    """
    found: dict[str, Any] = {"metric": METRIC, "x": "wall_s"}
    found |= {"alone": {}, "minutes": {}, "decisions": {}, "curves": []}
    for robot in sorted(path for path in folder.iterdir() if path.is_dir()):
        methods = sorted(path for path in robot.iterdir() if path.is_dir())
        both = {(robot.name, path.name): members(path) for path in methods}
        panel = {key: [timed for timed, _ in each] for key, each in both.items()}
        rows = found["minutes"][robot.name] = {}
        found["decisions"][robot.name] = {key[1]: by_decisions(each) for key, each in both.items()}
        for key, (each, notes) in count_failures(METRIC, panel).items():
            rows[key[1]] = {str(m): [after(one, m) for one in each] for m in MINUTES}
            curve = curve_of(key, METRIC, each, 0.0, notes)
            found["curves"].append(learning_curves.to_numbers(curve))
        taken = {f"{robot.name}, {typed(path.name)}": alone(path) for path in methods}
        found["alone"] |= {name: took for name, took in taken.items() if took}
    return found


def typed(method: str) -> str:
    """A method as one types it."""
    return METHODS.get(method, method)


def merged(kept: dict[str, Any], found: dict[str, Any]) -> dict[str, Any]:
    """`found`, and of `kept` the methods of each robot that it lacks, and its other keys."""
    curves = {
        (one["task"], one["label"]): one for numbers in (kept, found) for one in numbers["curves"]
    }
    both: dict[str, Any] = {"curves": [*curves.values()], "alone": kept["alone"] | found["alone"]}
    for name in ("minutes", "decisions"):
        robots = {**kept[name], **found[name]}
        both[name] = {r: kept[name].get(r, {}) | found[name].get(r, {}) for r in robots}
    return kept | found | both


def order(curve: Curve) -> tuple[int, int]:
    """Of a curve in the picture; unknown robots and methods come last."""
    robots, methods = [*ROBOTS, curve.task], [*METHODS, curve.label]
    return robots.index(curve.task), methods.index(curve.label)


def draw(found: dict[str, Any]) -> "Figure":
    """A panel for each robot, over the same minutes; grey while settings=quick is compiled."""
    curves = sorted(learning_curves.from_numbers(found), key=order)
    end = int(np.ceil(max(one.x[-1] for one in curves) / 60))
    titles = {one.task: ROBOTS.get(one.task, one.task) for one in curves}
    drawn = [replace(one, task=titles[one.task], label=typed(one.label)) for one in curves]
    picture = learning_curves.plot(drawn, "wall_s")
    for legend in [*picture.legends, *(axes.get_legend() for axes in picture.axes)]:
        if legend:
            legend.remove()
    for axes, robot in zip(picture.axes, titles, strict=True):
        axes.set(xlabel="Minutes from the command", xlim=(0, end))
        axes.set_xticks(range(0, end + 1, 1 + end // 10))
        if took := found["alone"].get(f"{robot}, {METHODS['quick']}"):
            ready = (took["before_s"] + took["compile_s"]) / 60
            about = f"{METHODS['quick']} is compiled"
            axes.axvspan(0, ready, color="0.92", lw=0, zorder=0, label=about)
    with studies.styled():
        style.legend_outside(*picture.axes)
    return picture


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    with chdir(given["runs"] or "."):  # the numbers name runs from there
        sources = [numbers(Path())] if given["runs"] else []
    if given["keep"]:
        sources.insert(0, json_file(Path(given["keep"])))
    if not sources:
        raise UsageError("runs, keep: give one of them, or both")
    found = reduce(merged, sources)
    studies.save(draw(found), found, output("out", given["out"], (".png",)))
    for robot, methods in found["minutes"].items():
        for method, rows in methods.items():
            known = {m: np.array(row, float) for m, row in rows.items()}
            ends = ", ".join(
                f"{m} min {spread(row)}" for m, row in known.items() if np.isfinite(row).all()
            )
            print(f"{robot}, {method}: {ends}")


if __name__ == "__main__":
    main()
