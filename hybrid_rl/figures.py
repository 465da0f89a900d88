"""Learning curves as a picture.

    python -m hybrid_rl.figures runs="runs/halfcheetah/*/*" metric=train/return out=figure.png

A panel for each task; a line for each algorithm: the interquartile mean over seeds with its 95%
bootstrap band (see hybrid_rl.curves). Several metrics, such as
metric=train/return,planner/mode_insertion_gradient, are one row of panels each. x=wall_s draws
over time, x=KEY over a number that a sweep went through, such as num_demonstrations. The numbers
drawn are written beside the picture, as JSON; what they come to is printed: last value, mean over
the run (the area under the curve), decisions to threshold=, and who is ahead of whom.
"""

if __name__ == "__main__":
    from hybrid_rl import interrupt

    interrupt.install()

import itertools
import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hybrid_rl import command
from hybrid_rl.arguments import Argument, number, output, read
from hybrid_rl.config import UsageError
from hybrid_rl.curves import Curve, area, band, curves, improvement, iqm, steps_to

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SUFFIXES = (".png", ".pdf", ".svg")
OF_X, OF_Y = " of steps (or seconds), 0 or more", " in the metric's unit"
RUNS = 'runs="GLOB", such as runs="runs/*/*/*"'
ARGUMENTS = (
    Argument("runs", "", "pattern of the run folders, in quotes", needed=RUNS),
    Argument("metric", "train/return", "metrics of metrics.jsonl, with commas between them"),
    Argument("out", "figure.png", f"the picture: {', '.join(SUFFIXES)}; numbers beside it"),
    Argument("x", "step", "step, wall_s, or a key that a sweep went through"),
    Argument("group", "algo", "key of the configuration with a curve for each of its values"),
    Argument("smooth", 0.0, "width of a moving mean, in units of x", number(0, OF_X)),
    Argument("threshold", None, "value of the metric: when is it reached?", number(what=OF_Y)),
)
COLOURS = (  # Okabe and Ito: told apart by colour-blind readers too
    "#0072B2",
    "#D55E00",
    "#009E73",
    "#CC79A7",
    "#E69F00",
    "#56B4E9",
    "#000000",
)
STROKES = ("-", "--", "-.", ":")  # when the colours are used up
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
}
TIMES = ((3600.0, "h"), (60.0, "min"), (1.0, "s"))  # [s]
STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "pdf.fonttype": 42,  # text stays text
    "svg.fonttype": "none",
    "svg.hashsalt": "hybrid_rl",  # the same numbers, the same file
}


def plot(drawn: Sequence[Curve], x: str = "step") -> "Figure":
    """A figure of `drawn`, one panel a task, at most three in a row; a row a metric if several."""
    import matplotlib
    from matplotlib.figure import Figure

    metrics = list(dict.fromkeys(curve.metric for curve in drawn))
    tasks = sorted({curve.task for curve in drawn})
    labels = sorted({curve.label for curve in drawn})
    across = min(3, len(tasks)) if len(metrics) == 1 else len(tasks)
    down = math.ceil(len(metrics) * len(tasks) / across)
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(4.4 * across, 3.3 * down), layout="constrained")
        panels = list(figure.subplots(down, across, squeeze=False).flat)
        for axes, (metric, task) in zip(panels, itertools.product(metrics, tasks), strict=False):
            of_panel = [curve for curve in drawn if (curve.metric, curve.task) == (metric, task)]
            if of_panel:
                _panel(axes, of_panel, labels, x)
                axes.set_title(task)
                axes.set_ylabel(LABELS.get(metric, metric))
            else:  # nothing of this metric in this task
                axes.set_axis_off()
        for axes in panels[len(metrics) * len(tasks) :]:
            axes.remove()
    return figure


def save(figure: "Figure", drawn: Sequence[Curve], out: str | Path, **said: str) -> Path:
    """Writes the picture, and the numbers in it as JSON beside it.

    said: more to write into the JSON, such as metric="train/return".
    """
    import matplotlib

    out = Path(out)
    if out.suffix not in SUFFIXES:
        raise UsageError(f"out={out}: must end in {', '.join(SUFFIXES)}")
    out.parent.mkdir(parents=True, exist_ok=True)
    undated = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}.get(out.suffix)
    with matplotlib.rc_context(STYLE):
        figure.savefig(out, dpi=200, metadata=undated)
    numbers = {
        **said,
        "line": "interquartile mean over seeds",
        "band": "95% percentile bootstrap over seeds",
        "curves": [_numbers(curve) for curve in drawn],
    }
    out.with_suffix(".json").write_text(json.dumps(numbers, indent=1) + "\n", encoding="utf-8")
    return out


def _panel(axes: "Axes", drawn: list[Curve], labels: list[str], x: str) -> None:
    """The lines of one task."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    end = max(curve.x[-1] for curve in drawn)
    unit, name = next(pair for pair in TIMES if end >= pair[0] or pair[0] == 1.0)
    scale = unit if x == "wall_s" else 1.0
    for curve in drawn:
        place = labels.index(curve.label)
        colour = COLOURS[place % len(COLOURS)]
        stroke = STROKES[place // len(COLOURS) % len(STROKES)]
        number = len(curve.seeds)
        label = f"{curve.label} ({number} seed{'s' * (number > 1)})"
        at = curve.x / scale
        dot = "o" if len(at) <= 10 else None
        axes.plot(
            at, curve.iqm, color=colour, linestyle=stroke, lw=1.6, marker=dot, ms=4, label=label
        )
        if number > 1:
            axes.fill_between(at, curve.low, curve.high, color=colour, alpha=0.2, lw=0)
    labels_of = {"wall_s": f"Wall time [{name}]", "step": "Environment steps per learner"}
    axes.set_xlabel(labels_of.get(x, x))
    axes.set_xlim(0, end / scale or 1.0)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5))
        axis.set_major_formatter(FuncFormatter(_thousands))
    axes.legend()


def _thousands(value: float, _: int | None = None) -> str:
    """-12,500 or 0.25, with a true minus sign."""
    return f"{value:,.10g}".replace("-", "\N{MINUS SIGN}")


def _numbers(curve: Curve) -> dict:
    """What is drawn of a curve, as JSON holds it."""
    arrays = {name: getattr(curve, name) for name in ("x", "iqm", "low", "high", "each")}
    return {
        "task": curve.task,
        "metric": curve.metric,
        "label": curve.label,
        "seeds": curve.seeds,
        "runs": curve.runs,
        "notes": curve.notes,
        **{name: array.astype("float32").tolist() for name, array in arrays.items()},
        "area": area(curve).astype("float32").tolist(),
    }


def told(drawn: Sequence[Curve], threshold: float | None = None) -> list[str]:
    """What the curves come to, a line each; then how often a method is ahead of another in area."""
    lines = []
    for curve in drawn:
        ends = f"{curve.iqm[-1]:,.4g} [{curve.low[-1]:,.4g}, {curve.high[-1]:,.4g}]"
        mean, (low, high) = iqm(area(curve)), band(area(curve))
        line = (
            f"{curve.task}, {curve.label}: {len(curve.seeds)} seeds, last {curve.metric} {ends}, "
            f"mean {mean:,.4g} [{low:,.4g}, {high:,.4g}]"
        )
        if threshold is not None:
            steps = steps_to(curve, threshold)
            line += f", {threshold:,.10g} reached by {np.isfinite(steps).sum()} of {len(steps)}"
            if np.isfinite(steps).all():
                line += f" at {iqm(steps):,.0f}"
        lines.append(line)
    for one, other in itertools.combinations(drawn, 2):
        if (one.task, one.metric) == (other.task, other.metric):
            rate, low, high = improvement(area(one), area(other))
            lines.append(
                f"{one.task}, {one.metric}: {one.label} ahead of {other.label} "
                f"in {rate:.0%} [{low:.0%}, {high:.0%}] of pairs"
            )
    return lines


def main() -> None:
    """The command."""
    said, _ = read(__doc__, ARGUMENTS)
    output("out", said["out"], SUFFIXES, ".json")
    x, group, smooth, threshold = (said[name] for name in ("x", "group", "smooth", "threshold"))
    metrics = [metric.strip() for metric in said["metric"].split(",")]
    each = [curves(said["runs"], metric, x, group, smooth) for metric in metrics]
    drawn = list(itertools.chain(*each))
    out = save(plot(drawn, x), drawn, said["out"], metric=said["metric"], x=x, group=group)
    print("\n".join(told(drawn, threshold)))
    for note in (note for curve in drawn for note in curve.notes):
        print(f"note: {note}")
    print(f"{out} and {out.with_suffix('.json')}")


if __name__ == "__main__":
    command.guarded(main)
