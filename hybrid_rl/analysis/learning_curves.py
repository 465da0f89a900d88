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
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from hybrid_rl.analysis import style, tables
from hybrid_rl.analysis.curves import Curve, area, curves, improvement, plural, spread
from hybrid_rl.analysis.results import redrawn
from hybrid_rl.analysis.studies import save
from hybrid_rl.cli.arguments import number
from hybrid_rl.errors import UsageError
from hybrid_rl.run.logs.progress import say

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

from numpy.typing import ArrayLike

ACROSS, DOWN = 60, 9  # [characters] of a curve in a console
LABELS = {
    "train/return": "Training return",
    "train/length": "Training episode length [steps]",
    "eval/return": "Evaluation return",
    "eval/policy_return": "Evaluation return, policy alone",
    "eval/planner_return": "Evaluation return, planner alone",
    "eval/success": "Share of successes",
    "eval/violations": "Violations per episode",
    "eval/policy_success": "Share of successes, policy alone",
    "eval/planner_success": "Share of successes, planner alone",
    "planner/mode_insertion_gradient": "Mode insertion gradient",
    "planner/policy_share": "Share of the policy in the action",
    "planner/insertion_per_variance": "Insertion gradient / policy variance",
    "planner/policy_variance": "Variance of the policy",
    "planner/lyapunov": "Lyapunov function V",
    "planner/lyapunov_rate": "Change of V under the policy [per decision]",
    "planner/lyapunov_bound": "Most that the plan adds to V [per decision]",
    "planner/handed_over": "Share of decisions handed over",
    "exploration/divergence": "Divergence of time average and target [nat]",
    "exploration/fourier_metric": "Fourier metric of ergodicity",
    "world/speed": "Speed [m/s]",
    "wall_s": "Wall time",
    "step": "Decisions",
    "num_demonstrations": "Number of demonstrations",
}
PANELS = ((4.4, 3.1), (4.4, 3.1), (3.0, 2.5))  # [in] of 1, 2, 3 across, without a legend
PER_INCH = 22  # [characters/in] fewer in the legend of a narrow panel
SHADE = 0.8  # sum of the opacities of the bands of a panel
MARGIN = 1.02  # of the last step, so that the marker there is whole
TIMES = ((3600.0, "h"), (60.0, "min"), (1.0, "s"))  # [s]
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
    one = in_characters(lines[0].x[known], lines[0].iqm[known], title, "decisions")
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
        where = "over the run"
        if between := each.get("between"):  # older files lack it
            where = "between {:,.10g} and {:,.10g}".format(*between)
        lines.append(
            f"{each['task']}, {each['metric']}: {each['label']} ahead of {each['other']} in "
            f"{rate:.0%} [{low:.0%}, {high:.0%}] of pairs of seeds, by the mean {where}"
        )
    if any(1 < len(curve.seeds) <= FEW for curve in drawn):
        lines.append(
            f"note: with {FEW} seeds or fewer an interval is their range, and not a 95% one"
        )
    return lines + [f"note: {note}" for curve in drawn for note in curve.notes]


def comparisons(drawn: Sequence[Curve]) -> list[dict[str, Any]]:
    """For each two curves of a task and a metric, the share of pairs of seeds that one leads.

    That is Agarwal et al.'s probability of improvement, of the means over the run, and its band;
    Where they begin or end apart these are means over what both have, `between` two x.
    """
    found = []
    for one, other in itertools.combinations(drawn, 2):
        both = one.shared.any() and other.shared.any()
        if both and (one.task, one.metric) == (other.task, other.metric):
            shared = [curve.x[curve.shared] for curve in (one, other)]
            since, until = max(x[0] for x in shared), min(x[-1] for x in shared)
            if since > until:
                continue
            share, *band = improvement(*(area(curve, since, until) for curve in (one, other)))
            whole = all((x[0], x[-1]) == (since, until) for x in shared)
            named = {"task": one.task, "metric": one.metric, "label": one.label}
            named |= {"other": other.label, "share": share, "band": band}
            found.append(named | {"between": None if whole else [float(since), float(until)]})
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


def plot(drawn: Sequence[Curve], x: str = "step", among: Sequence[str] = ()) -> "Figure":
    """One panel per task and metric; several metrics are rows if they fill the columns.

    Legends and the notes that name a curve are below and cover nothing. A line is thin where not
    all seeds have a value. among: the labels of several pictures that share their styles.
    """
    import matplotlib

    pairs = [(curve.metric, curve.task) for curve in drawn]
    metrics, tasks = (list(dict.fromkeys(names)) for names in zip(*pairs, strict=True))
    wanted = [pair for pair in itertools.product(metrics, tasks) if pair in pairs]
    each = [[c for c, own in zip(drawn, pairs, strict=True) if own == pair] for pair in wanted]
    styles = style.line_styles([*among, *(curve.label for curve in drawn)])
    across = _across(len(wanted), len(tasks) if len(metrics) > 1 else 0)
    down = math.ceil(len(wanted) / across)
    width, height = PANELS[across - 1]
    own = [note for curve in drawn for note in curve.notes if note.startswith(f"{curve.task}, ")]
    notes = style.wrapped(own, round(style.NOTE_WIDTH * across * width / PANELS[0][0]))
    labels, texts = {curve.label for curve in drawn}, {*map(_entry, drawn)}
    one_legend = len(wanted) > 1 and len(texts) == len(labels) and not notes
    entries = len(texts) if one_legend else down * max(map(len, each))
    with matplotlib.rc_context(style.STYLE):
        size = width * across, height * down + style.ENTRY * (entries + len(notes))
        figure = style.blank(*size)
        panels = list(figure.subplots(down, across, squeeze=False).flat)
        for axes, some, (metric, task) in zip(panels, each, wanted, strict=False):
            axes.set_title(style.words(task))
            _panel(axes, some, styles, x, 5 if across < 3 else 3)
            axes.set_ylabel(LABELS.get(metric, metric))
            if not one_legend:
                narrower = round(PER_INCH * (PANELS[0][0] - width))
                style.legend_below(axes, style.LEGEND_WIDTH - narrower)
        if one_legend:
            style.legend_outside(*panels[: len(wanted)])
        for axes in panels[len(wanted) :]:
            axes.remove()
        style.write_notes(figure, notes)
    return figure


def _across(panels: int, columns: int) -> int:
    """Panels in a row: `columns` if that fills all rows, else a number that leaves no gap."""
    if 1 < columns <= len(PANELS) and panels % columns == 0:
        return columns
    return panels if panels <= 3 else next((n for n in (3, 2) if panels % n == 0), 3)


def _entry(curve: Curve) -> str:
    """A curve in a legend."""
    return f"{style.words(curve.label)} ({plural(len(curve.seeds), 'seed')})"


def _panel(axes: "Axes", drawn: list[Curve], styles: dict[str, Any], x: str, ticks: int) -> None:
    """The lines of one task and metric."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    end = max(curve.x[-1] for curve in drawn)
    unit, name = next(pair for pair in TIMES if end >= pair[0] or pair[0] == 1.0)
    scale = unit if x == "wall_s" else 1.0
    for curve in drawn:
        line = styles[curve.label] | ({} if len(curve.x) <= 10 else {"marker": None})
        _line(axes, curve, curve.x / scale, line, min(0.2, SHADE / len(drawn)))
    axes.set_xlabel(LABELS.get(x, style.words(x)) + (f" [{name}]" if x == "wall_s" else ""))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5))
        axis.set_major_formatter(FuncFormatter(style.thousands))
    if x in ("wall_s", "step"):
        axes.set_xticks(MaxNLocator(ticks).tick_values(0, end / scale))  # up to the last step
        axes.set_xlim(0, MARGIN * end / scale or 1.0)


def _line(axes: "Axes", curve: Curve, at: np.ndarray, line: Any, shade: float) -> None:
    """One curve and its band; thin where not all seeds have a value."""
    shared = curve.shared
    axes.plot(at, np.where(shared, curve.iqm, np.nan), lw=1.6, ms=4, label=_entry(curve), **line)
    if not shared.all():
        next_to = ~shared | np.append(~shared[1:], False) | np.append(False, ~shared[:-1])
        thin = line | {"marker": "." if line["marker"] else None}
        axes.plot(at, np.where(next_to, curve.iqm, np.nan), lw=0.7, ms=3, **thin)
    if len(curve.seeds) > 1:
        ends = curve.low, curve.high
        axes.fill_between(at, *ends, where=shared, color=line["color"], alpha=shade, lw=0)


def in_characters(x: ArrayLike, y: ArrayLike, title: str, below: str) -> str:
    """A curve for a console: through x [N], increasing, and y [N], with the limits of both.

    title: above the curve; below: the unit of x.
    """
    x, y = np.asarray(x), np.asarray(y)
    low, high = y.min(), y.max()
    at = np.interp(np.linspace(x[0], x[-1], ACROSS), x, y)
    share = (at - low) / (high - low) if high > low else np.zeros(ACROSS)
    rows = np.rint(share * (DOWN - 1)).astype(int)
    span = high - low
    digits = max(0, 1 - math.floor(math.log10(span))) if 0 < span < math.inf else 0
    labels = {DOWN - 1: f"{high:,.{digits}f}", 0: f"{low:,.{digits}f}"}
    margin = max(map(len, labels.values()))
    lines = [title]
    for row in reversed(range(DOWN)):
        text = "".join("*" if here == row else " " for here in rows)
        lines.append(f"{labels.get(row, ''):>{margin}} |{text}".rstrip())
    first, last = f"{x[0]:,.0f}", f"{x[-1]:,.0f} {below}"
    lines.append(" " * margin + " +" + "-" * ACROSS)
    lines.append(" " * (margin + 2) + first + last.rjust(ACROSS - len(first)))
    return "\n".join(lines)
