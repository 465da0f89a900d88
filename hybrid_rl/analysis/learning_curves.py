"""Learning curves: interquartile mean over seeds with its 95% bootstrap band.

    python -m hybrid_rl.figures runs="runs/halfcheetah/*/*" metric=train/return out=figure.png

One panel per task; one line per algorithm and, where its runs differ in their settings, per set of
settings (hybrid_rl.analysis.curves). Several metrics, such as
metric=train/return,planner/mode_insertion_gradient, are one row of panels each. x=wall_s plots over
time, x=KEY over a number that was swept, such as num_demonstrations. runs=FILE.json redraws a
figure from its JSON. out=FILE.csv writes a table instead, a value of a seed in each row, with the
columns exp_name, env_name, seed, metric, env_step, value (hybrid_rl.analysis.tables);
others=FILE.csv draws the curves of such a table, of another library's runs, beside these.

The summary has the last value, the mean over the run (the area under the curve), and in which share
of pairs of seeds one method is ahead of another. Notes on missing values and failed seeds are in
the picture and in the JSON.
"""

import itertools
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from hybrid_rl.analysis import tables
from hybrid_rl.analysis.curves import (
    Curve,
    area,
    curves,
    improvement,
    plural,
    spread,
)
from hybrid_rl.analysis.curves_picture import LABELS, plot
from hybrid_rl.analysis.results import redrawn
from hybrid_rl.analysis.studies import save
from hybrid_rl.cli.arguments import number
from hybrid_rl.errors import UsageError
from hybrid_rl.run.logs import curve as text
from hybrid_rl.run.logs.progress import say

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ARRAYS = ("x", "each", "iqm", "low", "high")  # of a curve
EVALUATION = "eval/return"
LEAST = 3  # evaluations of a curve that is shown
FEW = 4  # seeds, of whose resamples more than 2.5% have the lowest one as their mean
WIDTH = number(0, " of steps (or seconds), 0 or more")


def figure(
    runs: Annotated[str | Path, 'run folders, as "runs/*/*/*" or "a/*,b/*"; or a JSON to redraw'],
    metric: Annotated[str, "metrics of metrics.jsonl, with commas between them"] = "train/return",
    x: Annotated[str, "step, wall_s, or a key that was swept"] = "step",
    group: Annotated[str, "key of the configuration, with a curve for each value"] = "algo",
    smooth: Annotated[float, "width of a moving mean, in units of x", WIDTH] = 0.0,
    others: Annotated[str, "a table as out=FILE.csv writes, to draw beside the runs"] = "",
) -> tuple["Figure", dict[str, Any]]:
    """The learning curves of `runs`, and their numbers."""
    if str(runs).endswith(".json") and not others:
        return redrawn(runs, "runs", draw)
    drawn = []
    for name in map(str.strip, metric.split(",")):
        ours = curves(runs, name, x, group, smooth)
        tasks = {curve.task for curve in ours}
        drawn += ours + (tables.read(others, name, tasks, x, smooth) if others else [])
    numbers = {
        "metric": metric,
        "x": x,
        "group": group,
        "line": "interquartile mean over seeds",
        "band": "95% percentile bootstrap over seeds",
        "curves": [to_numbers(curve) for curve in drawn],
        "comparisons": comparisons(drawn),
    }
    return draw(numbers), numbers


def show(run_dir: Path) -> None:
    """Print and draw the evaluations of a run, if there are at least LEAST of them."""
    try:
        lines = curves(run_dir, EVALUATION)
    except UsageError:  # there are none
        return
    known = np.isfinite(lines[0].iqm)
    if known.sum() < LEAST:
        return
    drawn = run_dir / "curve.png"
    try:
        save(*figure(run_dir, EVALUATION), drawn)
    except OSError as error:
        say(f"{drawn}: not written ({error.strerror or error})")
    seeds = len(lines[0].seeds)
    mean = f", interquartile mean of {seeds} seeds" if seeds > 1 else ""
    title = f"{LABELS[EVALUATION]}{mean} ({drawn})"
    one = text.drawn(lines[0].x[known], lines[0].iqm[known], title, "decisions")
    say(one if len(lines) == 1 else title)


def summary(numbers: dict[str, Any]) -> list[str]:
    """A line per curve, up to the last point that all its seeds have; then comparisons by area."""
    drawn, lines = from_numbers(numbers), []
    for curve in drawn:
        if not curve.shared.any():
            lines.append(f"{curve.task}, {curve.label}: no point that all its seeds have")
            continue
        last = np.flatnonzero(curve.shared)[-1]
        ends = spread(curve.each[:, last])
        if last < len(curve.x) - 1:
            ends += f" at {curve.x[last]:,.10g}"
        lines.append(
            f"{curve.task}, {curve.label}: {plural(len(curve.seeds), 'seed')}, "
            f"last {curve.metric} {ends}, mean over the run {spread(area(curve))}"
        )
    for each in numbers["comparisons"] if "comparisons" in numbers else comparisons(drawn):
        rate, low, high = each["share"], *each["band"]
        until = each.get("until")  # older files lack it
        lines.append(
            f"{each['task']}, {each['metric']}: {each['label']} ahead of {each['other']} in "
            f"{rate:.0%} [{low:.0%}, {high:.0%}] of pairs of seeds, by the mean "
            + ("over the run" if until is None else f"up to {until:,.10g}, where the shorter ends")
        )
    if any(1 < len(curve.seeds) <= FEW for curve in drawn):
        lines.append(
            f"note: with {FEW} seeds or fewer an interval is their range, and not a 95% one"
        )
    return lines + [f"note: {note}" for curve in drawn for note in curve.notes]


def comparisons(drawn: Sequence[Curve]) -> list[dict[str, Any]]:
    """For each two curves of a task and a metric, the share of pairs of seeds that one leads.

    That is Agarwal et al.'s probability of improvement, of the means over the run, and its band;
    `until` is the x where the shorter one ends, None if both end there.
    """
    found = []
    for one, other in itertools.combinations(drawn, 2):
        both = one.shared.any() and other.shared.any()
        if both and (one.task, one.metric) == (other.task, other.metric):
            ends = [float(curve.x[curve.shared][-1]) for curve in (one, other)]
            share, *band = improvement(*(area(curve, min(ends)) for curve in (one, other)))
            named = {"task": one.task, "metric": one.metric, "label": one.label}
            until = None if ends[0] == ends[1] else min(ends)
            found.append(
                {**named, "other": other.label, "share": share, "band": band, "until": until}
            )
    return found


def table(numbers: dict[str, Any]) -> str:
    """The curves as text of a long table."""
    return tables.text(from_numbers(numbers), numbers["x"])


def to_numbers(curve: Curve) -> dict[str, Any]:
    """A curve as the JSON holds it, in float32."""
    return {
        **{name: getattr(curve, name) for name in ("task", "metric", "label")},
        **{name: list(getattr(curve, name)) for name in ("seeds", "runs", "notes")},
        **{name: getattr(curve, name).astype("float32") for name in ARRAYS},
        "area": area(curve).astype("float32"),
    }


def from_numbers(numbers: dict[str, Any]) -> list[Curve]:
    """The curves of a JSON; null becomes NaN."""
    drawn = []
    for one in numbers["curves"]:
        metric = one.get("metric", numbers["metric"])
        seeds, runs, notes = (tuple(one[name]) for name in ("seeds", "runs", "notes"))
        arrays = [np.array(one[name], float) for name in ARRAYS]
        drawn.append(Curve(one["task"], metric, one["label"], seeds, runs, *arrays, notes=notes))
    return drawn


def draw(numbers: dict[str, Any]) -> "Figure":
    """The picture of numbers from a JSON."""
    return plot(from_numbers(numbers), numbers["x"])
