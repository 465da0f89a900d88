"""Learning curves: interquartile mean over seeds with its 95% bootstrap band.

    python -m hybrid_rl.figures runs="runs/halfcheetah/*/*" metric=train/return out=figure.png

One panel per task; one line per algorithm and, where its runs differ in their settings, per set of
settings (hybrid_rl.studies.curves). Several metrics, such as
metric=train/return,planner/mode_insertion_gradient, are one row of panels each. x=wall_s plots over
time, x=KEY over a number that was swept, such as num_demonstrations. runs=FILE.json redraws a
figure from its JSON. out=FILE.csv writes a table instead, a value of a seed in each row, with the
columns exp_name, env_name, seed, metric, env_step, value (hybrid_rl.studies.long_table).

The summary has the last value, the mean over the run (the area under the curve), the decisions to
reach threshold=, and in which share of pairs of seeds one method is ahead of another. Notes on
missing values and failed seeds are in the picture and in the JSON.
"""

import itertools
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from hybrid_rl.cli.arguments import number
from hybrid_rl.errors import UsageError
from hybrid_rl.run.reading import json_file
from hybrid_rl.studies.curves import (
    Curve,
    area,
    curves,
    improvement,
    iqm,
    plural,
    spread,
    steps_to,
)
from hybrid_rl.studies.long_table import long_table
from hybrid_rl.studies.style import (
    COLOURS,
    ENTRY,
    NOTE_WIDTH,
    STROKES,
    STYLE,
    legend_below,
    thousands,
    wrapped,
    write_notes,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LABELS = {
    "train/return": "Training return",
    "train/length": "Training episode length [steps]",
    "eval/return": "Evaluation return",
    "eval/policy_return": "Evaluation return, policy alone",
    "eval/planner_return": "Evaluation return, planner alone",
    "eval/success": "Share of successes",
    "eval/policy_success": "Share of successes, policy alone",
    "eval/planner_success": "Share of successes, planner alone",
    "planner/mode_insertion_gradient": "Mode insertion gradient",
    "planner/policy_share": "Share of the policy in the action",
    "planner/insertion_per_variance": "Insertion gradient / policy variance",
    "planner/lyapunov": "Lyapunov function V",
    "planner/lyapunov_rate": "Change of V under the policy [per decision]",
    "planner/lyapunov_bound": "Most that the plan adds to V [per decision]",
    "planner/handed_over": "Share of decisions handed over",
}
PANEL = (4.4, 3.1)  # [in] of a panel, without its legend
MOST_ACROSS = 4
MARGIN = 1.02  # of the last step, so that the marker there is whole
TIMES = ((3600.0, "h"), (60.0, "min"), (1.0, "s"))  # [s]
ARRAYS = ("x", "each", "iqm", "low", "high")  # of a curve
WIDTH = number(0, " of steps (or seconds), 0 or more")
VALUE = number(what=" in the metric's unit")


def figure(
    runs: Annotated[str | Path, 'run folders, as "runs/*/*/*" in quotes; or a JSON to redraw'],
    metric: Annotated[str, "metrics of metrics.jsonl, with commas between them"] = "train/return",
    x: Annotated[str, "step, wall_s, or a key that was swept"] = "step",
    group: Annotated[str, "key of the configuration, with a curve for each value"] = "algo",
    smooth: Annotated[float, "width of a moving mean, in units of x", WIDTH] = 0.0,
    threshold: Annotated[float | None, "value of the metric to reach", VALUE] = None,
) -> tuple["Figure", dict[str, Any]]:
    """The learning curves of `runs`, and their numbers."""
    if str(runs).endswith(".json"):
        numbers = _read(runs)
    else:
        metrics = [name.strip() for name in metric.split(",")]
        each = [curves(runs, name, x, group, smooth) for name in metrics]
        numbers = {
            "metric": metric,
            "x": x,
            "group": group,
            "line": "interquartile mean over seeds",
            "band": "95% percentile bootstrap over seeds",
            "curves": [to_numbers(curve) for curve in itertools.chain(*each)],
        }
    if threshold is not None:
        numbers["threshold"] = threshold
    return plot(from_numbers(numbers), numbers["x"]), numbers


def summary(numbers: dict[str, Any]) -> list[str]:
    """A line per curve, up to the last point that all its seeds have; then comparisons by area."""
    threshold, drawn = numbers.get("threshold"), from_numbers(numbers)
    lines = []
    for curve in drawn:
        if not curve.shared.any():
            lines.append(f"{curve.task}, {curve.label}: no point that all its seeds have")
            continue
        last = np.flatnonzero(curve.shared)[-1]
        ends = spread(curve.each[:, last])
        if last < len(curve.x) - 1:
            ends += f" at {curve.x[last]:,.10g}"
        line = (
            f"{curve.task}, {curve.label}: {plural(len(curve.seeds), 'seed')}, "
            f"last {curve.metric} {ends}, mean {spread(area(curve))}"
        )
        if threshold is not None:
            steps = steps_to(curve, threshold)
            line += f", {threshold:,.10g} reached by {np.isfinite(steps).sum()} of {len(steps)}"
            if np.isfinite(steps).all():
                line += f" at {iqm(steps):,.0f}"
        lines.append(line)
    for one, other in itertools.combinations(drawn, 2):
        both = one.shared.any() and other.shared.any()
        if both and (one.task, one.metric) == (other.task, other.metric):
            rate, low, high = improvement(area(one), area(other))
            lines.append(
                f"{one.task}, {one.metric}: {one.label} ahead of {other.label} "
                f"in {rate:.0%} [{low:.0%}, {high:.0%}] of pairs"
            )
    return lines + [f"note: {note}" for curve in drawn for note in curve.notes]


def table(numbers: dict[str, Any]) -> str:
    """The curves as text of a long table."""
    return long_table(from_numbers(numbers), numbers["x"])


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


def _read(file: str | Path) -> dict[str, Any]:
    """The numbers of a learning-curve figure.

    Raises:
        UsageError: if the file cannot be read or has no curves.
    """
    try:
        numbers = json_file(Path(file))
        from_numbers(numbers)
        return numbers
    except UsageError as error:
        raise UsageError(f"runs={error}") from error
    except (ValueError, KeyError, TypeError) as error:
        raise UsageError(f"runs={file}: has no curves written by figures") from error


def plot(drawn: Sequence[Curve], x: str = "step") -> "Figure":
    """One panel per task and metric; several metrics are rows if they fill the columns.

    The legend of a panel and the curves' notes are below it and cover nothing. A line is thin
    where not all seeds have a value.
    """
    import matplotlib
    from matplotlib.figure import Figure

    pairs = [(curve.metric, curve.task) for curve in drawn]
    metrics, tasks = (list(dict.fromkeys(names)) for names in zip(*pairs, strict=True))
    wanted = [pair for pair in itertools.product(metrics, sorted(tasks)) if pair in pairs]
    labels = sorted({curve.label for curve in drawn})
    across = _across(len(wanted), len(tasks) if len(metrics) > 1 else 0)
    down = math.ceil(len(wanted) / across)
    notes = wrapped([note for curve in drawn for note in curve.notes], NOTE_WIDTH * across)
    entries = max(pairs.count(pair) for pair in wanted)
    height = PANEL[1] * down + ENTRY * (down * entries + len(notes))
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(PANEL[0] * across, height), layout="constrained")
        panels = list(figure.subplots(down, across, squeeze=False).flat)
        for axes, pair in zip(panels, wanted, strict=False):
            _panel(axes, [c for c, own in zip(drawn, pairs, strict=True) if own == pair], labels, x)
            axes.set(title=pair[1], ylabel=LABELS.get(pair[0], pair[0]))
        for axes in panels[len(wanted) :]:
            axes.remove()
        write_notes(figure, notes)
    return figure


def _across(panels: int, columns: int) -> int:
    """Panels in a row: `columns` if that fills all rows, else a number that leaves no gap."""
    if 1 < columns <= MOST_ACROSS and panels % columns == 0:
        return columns
    full = [number for number in (3, 4, 2) if panels % number == 0]
    return panels if panels <= 3 else (full or [3])[0]


def _panel(axes: "Axes", drawn: list[Curve], labels: list[str], x: str) -> None:
    """The lines of one task and metric."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    end = max(curve.x[-1] for curve in drawn)
    unit, name = next(pair for pair in TIMES if end >= pair[0] or pair[0] == 1.0)
    scale = unit if x == "wall_s" else 1.0
    for curve in drawn:
        index = labels.index(curve.label)
        style: Any = {
            "color": COLOURS[index % len(COLOURS)],
            "linestyle": STROKES[index // len(COLOURS) % len(STROKES)],
            "marker": "o" if len(curve.x) <= 10 else None,
        }
        _line(axes, curve, curve.x / scale, style)
    labels_of = {"wall_s": f"Wall time [{name}]", "step": "Environment steps per learner"}
    axes.set_xlabel(labels_of.get(x, x))
    if x in labels_of:
        axes.set_xlim(0, MARGIN * end / scale or 1.0)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5))
        axis.set_major_formatter(FuncFormatter(thousands))
    legend_below(axes)


def _line(axes: "Axes", curve: Curve, at: np.ndarray, style: Any) -> None:
    """One curve and its band; thin where not all seeds have a value."""
    shared, label = curve.shared, f"{curve.label} ({plural(len(curve.seeds), 'seed')})"
    axes.plot(at, np.where(shared, curve.iqm, np.nan), lw=1.6, ms=4, label=label, **style)
    if not shared.all():
        next_to = ~shared | np.append(~shared[1:], False) | np.append(False, ~shared[:-1])
        thin = style | {"marker": "." if style["marker"] else None}
        axes.plot(at, np.where(next_to, curve.iqm, np.nan), lw=0.7, ms=3, **thin)
    if len(curve.seeds) > 1:
        ends = curve.low, curve.high
        axes.fill_between(at, *ends, where=shared, color=style["color"], alpha=0.2, lw=0)
