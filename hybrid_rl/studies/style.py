"""Curves as a picture: panels, lines and bands, and legends that cover nothing."""

import itertools
import math
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from hybrid_rl.studies.curves import Curve

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = (  # Okabe and Ito: distinct for colour-blind readers, too
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
    "planner/insertion_per_variance": "Insertion gradient / policy variance",
}
PANEL = (4.4, 3.1)  # [in] of a panel, without its legend
ENTRY = 0.15  # [in] of a line of a legend, or of a note
LEGEND_WIDTH = 55  # [characters] under a panel
BELOW, BELOW_TICKS = 34, 20  # [pt] from the axes to a legend: tick labels, the label of x
NOTE_WIDTH = 78  # [characters] under a panel
MOST_NOTES, MOST_ACROSS = 8, 4
MARGIN = 1.02  # of the last step: a marker there is whole
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
    """A figure of `drawn`, a panel a task and metric; several metrics are rows where they fit.

    The legend of a panel and the curves' notes lie below it, and cover nothing. Where not all
    seeds have a value a line is thin.
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
        if notes:
            figure.supxlabel("\n".join(notes), x=0.01, ha="left", fontsize=6.5, color="#444444")
    return figure


def _across(panels: int, columns: int) -> int:
    """Panels in a row: `columns` where that fills all rows, else a number that leaves no gap."""
    if 1 < columns <= MOST_ACROSS and panels % columns == 0:
        return columns
    full = [number for number in (3, 4, 2) if panels % number == 0]
    return panels if panels <= 3 else (full or [3])[0]


def wrapped(notes: Sequence[str], width: int) -> list[str]:
    """Lines of a width; of many notes the first, and how many more there are."""
    shown = list(dict.fromkeys(notes))[:MOST_NOTES]
    lines = [
        line for note in shown for line in textwrap.wrap(textwrap.shorten(note, 3 * width), width)
    ]
    more = len(set(notes)) - len(shown)
    return [*lines, f"and {more} more notes, in the JSON beside this picture"] if more else lines


def _panel(axes: "Axes", drawn: list[Curve], labels: list[str], x: str) -> None:
    """The lines of one task."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    end = max(curve.x[-1] for curve in drawn)
    unit, name = next(pair for pair in TIMES if end >= pair[0] or pair[0] == 1.0)
    scale = unit if x == "wall_s" else 1.0
    for curve in drawn:
        number = labels.index(curve.label)
        style: Any = {
            "color": COLOURS[number % len(COLOURS)],
            "linestyle": STROKES[number // len(COLOURS) % len(STROKES)],
            "marker": "o" if len(curve.x) <= 10 else None,
        }
        _line(axes, curve, curve.x / scale, style)
    labels_of = {"wall_s": f"Wall time [{name}]", "step": "Environment steps per learner"}
    axes.set_xlabel(labels_of.get(x, x))
    if x in labels_of:
        axes.set_xlim(0, MARGIN * end / scale or 1.0)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5))
        axis.set_major_formatter(FuncFormatter(_thousands))
    legend_below(axes)


def _line(axes: "Axes", curve: Curve, at: np.ndarray, style: Any) -> None:
    """One curve and its band; thin where not all seeds have a value."""
    number, shared = len(curve.seeds), curve.shared
    label = f"{curve.label} ({number} seed{'s' * (number > 1)})"
    axes.plot(at, np.where(shared, curve.iqm, np.nan), lw=1.6, ms=4, label=label, **style)
    if not shared.all():
        next_to = ~shared | np.append(~shared[1:], False) | np.append(False, ~shared[:-1])
        thin = style | {"marker": "." if style["marker"] else None}
        axes.plot(at, np.where(next_to, curve.iqm, np.nan), lw=0.7, ms=3, **thin)
    if number > 1:
        ends = curve.low, curve.high
        axes.fill_between(at, *ends, where=shared, color=style["color"], alpha=0.2, lw=0)


def legend_below(axes: "Axes") -> None:
    """A legend under the label of the x axis: it covers no curve."""
    from matplotlib.transforms import ScaledTranslation

    texts = axes.get_legend_handles_labels()[1]
    columns = int(LEGEND_WIDTH / (max(map(len, texts), default=1) + 7))
    down = (BELOW if axes.get_xlabel() else BELOW_TICKS) / 72
    lower = ScaledTranslation(0, -down, axes.figure.dpi_scale_trans)
    axes.legend(
        loc="upper left",
        bbox_to_anchor=(0, 0),
        bbox_transform=axes.transAxes + lower,
        borderaxespad=0,
        borderpad=0,
        frameon=False,
        fontsize=8,
        ncols=max(1, min(len(texts), columns)),
    )


def plain_log(axis: Any) -> None:
    """Tick labels of a logarithmic axis, after its data, as plain numbers: few, in any range."""
    from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator

    low, high = axis.get_view_interval()
    wide = high > 8 * low
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)) if wide else MaxNLocator(5))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(_thousands))


def _thousands(value: float, _: int | None = None) -> str:
    """-12,500 or 0.25, with a true minus sign."""
    return f"{value:,.10g}".replace("-", "\N{MINUS SIGN}")
