"""Pictures of learning curves: a panel per task and metric, lines with bands."""

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from hybrid_rl.analysis.curves import Curve, plural
from hybrid_rl.analysis.style import (
    ENTRY,
    LEGEND_WIDTH,
    NOTE_WIDTH,
    STYLE,
    blank,
    legend_below,
    legend_outside,
    line_styles,
    thousands,
    words,
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


def plot(drawn: Sequence[Curve], x: str = "step") -> "Figure":
    """One panel per task and metric; several metrics are rows if they fill the columns.

    Legends and the notes that name a curve are below and cover nothing. A line is thin where not
    all seeds have a value.
    """
    import matplotlib

    pairs = [(curve.metric, curve.task) for curve in drawn]
    metrics, tasks = (list(dict.fromkeys(names)) for names in zip(*pairs, strict=True))
    wanted = [pair for pair in itertools.product(metrics, sorted(tasks)) if pair in pairs]
    each = [[c for c, own in zip(drawn, pairs, strict=True) if own == pair] for pair in wanted]
    styles = line_styles([curve.label for curve in drawn])
    across = _across(len(wanted), len(tasks) if len(metrics) > 1 else 0)
    down = math.ceil(len(wanted) / across)
    width, height = PANELS[across - 1]
    own = [note for curve in drawn for note in curve.notes if note.startswith(f"{curve.task}, ")]
    notes = wrapped(own, round(NOTE_WIDTH * across * width / PANELS[0][0]))
    same = len({tuple(map(_entry, some)) for some in each}) == 1
    one_legend = len(wanted) > 1 and same and not notes
    entries = len(each[0]) if one_legend else down * max(map(len, each))
    with matplotlib.rc_context(STYLE):
        size = width * across, height * down + ENTRY * (entries + len(notes))
        figure = blank(*size)
        panels = list(figure.subplots(down, across, squeeze=False).flat)
        for axes, some, (metric, task) in zip(panels, each, wanted, strict=False):
            axes.set_title(words(task))
            _panel(axes, some, styles, x)
            axes.set_ylabel(LABELS.get(metric, metric))
            if not one_legend:
                legend_below(axes, LEGEND_WIDTH - round(PER_INCH * (PANELS[0][0] - width)))
        if one_legend:
            legend_outside(panels[0])
        for axes in panels[len(wanted) :]:
            axes.remove()
        write_notes(figure, notes)
    return figure


def _across(panels: int, columns: int) -> int:
    """Panels in a row: `columns` if that fills all rows, else a number that leaves no gap."""
    if 1 < columns <= len(PANELS) and panels % columns == 0:
        return columns
    return panels if panels <= 3 else next((n for n in (3, 2) if panels % n == 0), 3)


def _entry(curve: Curve) -> str:
    """A curve in a legend."""
    return f"{words(curve.label)} ({plural(len(curve.seeds), 'seed')})"


def _panel(axes: "Axes", drawn: list[Curve], styles: dict[str, Any], x: str) -> None:
    """The lines of one task and metric."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    end = max(curve.x[-1] for curve in drawn)
    unit, name = next(pair for pair in TIMES if end >= pair[0] or pair[0] == 1.0)
    scale = unit if x == "wall_s" else 1.0
    for curve in drawn:
        style = styles[curve.label] | ({} if len(curve.x) <= 10 else {"marker": None})
        _line(axes, curve, curve.x / scale, style, min(0.2, SHADE / len(drawn)))
    axes.set_xlabel(LABELS.get(x, words(x)) + (f" [{name}]" if x == "wall_s" else ""))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5))
        axis.set_major_formatter(FuncFormatter(thousands))
    if x in ("wall_s", "step"):
        axes.set_xticks(MaxNLocator(5).tick_values(0, end / scale))  # up to the last step
        axes.set_xlim(0, MARGIN * end / scale or 1.0)


def _line(axes: "Axes", curve: Curve, at: np.ndarray, style: Any, shade: float) -> None:
    """One curve and its band; thin where not all seeds have a value."""
    shared = curve.shared
    axes.plot(at, np.where(shared, curve.iqm, np.nan), lw=1.6, ms=4, label=_entry(curve), **style)
    if not shared.all():
        next_to = ~shared | np.append(~shared[1:], False) | np.append(False, ~shared[:-1])
        thin = style | {"marker": "." if style["marker"] else None}
        axes.plot(at, np.where(next_to, curve.iqm, np.nan), lw=0.7, ms=3, **thin)
    if len(curve.seeds) > 1:
        ends = curve.low, curve.high
        axes.fill_between(at, *ends, where=shared, color=style["color"], alpha=shade, lw=0)
