"""Pictures of falling quadcopters: information, errors, and trials at rest."""

from typing import Any

import numpy as np

from hybrid_rl.analysis.style import (
    blank,
    legend_outside,
    line_styles,
    plain_log,
    thousands,
    words,
)
from hybrid_rl.thesis.studies.dots import ROW_HEIGHT, row_points
from hybrid_rl.thesis.studies.falls import STILL, falls, regressors, reported

POINTS = 400  # of a line over time
LOWEST = 1e-4  # of the errors' axis


def information(pattern: str) -> tuple[Any, dict[str, Any]]:
    """Figure 7-2: information, error, share at rest."""
    numbers = _measured(pattern)
    return draw_information(numbers), numbers


def initial(pattern: str) -> tuple[Any, dict[str, Any]]:
    """Figure 7-3: error and share at rest by the first K."""
    numbers = _measured(pattern)
    return draw_initial(numbers), numbers


def _measured(pattern: str) -> dict[str, Any]:
    each = falls(pattern)
    return {"methods": {fall.label: reported(fall, regressors(fall)) for fall in each}}


def draw_information(numbers: dict[str, Any]) -> Any:
    """Information after a second as rows, error and share at rest as lines over time."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    methods = numbers["methods"]
    figure = blank(9, 2.9 + 2.4 + ROW_HEIGHT * len(methods))
    grid: Any = figure.subplots(2, 2, height_ratios=(1 + ROW_HEIGHT * len(methods), 3.2))
    (traces, determinants), (errors, shares) = grid
    for axes, name in ((traces, "trace_1_s"), (determinants, "log_det_1_s")):
        row_points(axes, {label: [one[name]] for label, one in methods.items()})
        axes.xaxis.set_major_locator(MaxNLocator(4))
        axes.xaxis.set_major_formatter(FuncFormatter(thousands))
    traces.set_title("Information after 1 s, trace")
    determinants.set(title="Its log determinant", yticklabels=[])
    styles = line_styles(methods)
    for label, one in methods.items():
        style = styles[label] | {"label": words(label)}
        marks = sorted(one["error"], key=float)
        middle, low, high = np.array([one["error"][mark] for mark in marks]).T
        times = np.array(marks, float)
        errors.plot(times, middle, ms=4, **style)
        errors.fill_between(times, low, high, color=style["color"], alpha=0.07, lw=0)
        at = np.linspace(0, times[-1], POINTS)
        rest = np.asarray(one["time_at_rest"])[:, None] <= at + 1e-9
        shares.plot(at, 100 * rest.mean(0), **style | {"marker": None})
    _error_axis(errors.yaxis)
    errors.axhline(STILL, color="k", lw=0.6)
    errors.set(xlabel="Time [s]", title="|v|² + |w|², median and 10 to 90%", ylim=(LOWEST, None))
    shares.set(xlabel="Time [s]", title="Trials at rest from then on [%]", ylim=(-2, 102))
    legend_outside(errors)
    return figure


def draw_initial(numbers: dict[str, Any]) -> Any:
    """A row for each first K: error and share of the trials at rest at two times."""
    methods = numbers["methods"]
    figure = blank(9, 1.3 + 1.3 * ROW_HEIGHT * len(methods))
    errors, shares = figure.subplots(1, 2, sharey=True)
    both = [set(one["error"]) & set(one["at_rest"]) for one in methods.values()]
    times = sorted(set.intersection(*both), key=float)
    times = list(dict.fromkeys([times[0], times[-1]]))
    marks = [f"after {time} s" for time in times]
    each = {label: [one["error"][time] for time in times] for label, one in methods.items()}
    row_points(errors, each, marks)
    legend_outside(errors)
    each = {
        label: [100 * np.asarray(one["at_rest"][time]) for time in times]
        for label, one in methods.items()
    }
    row_points(shares, each)
    errors.set_title("|v|² + |w|², median and 10 to 90%")
    _error_axis(errors.xaxis, narrow=True)
    shares.set(title="Trials at rest from then on [%], Wilson's 95%", xlim=(-3, 103))
    return figure


def _error_axis(axis: Any, narrow: bool = False) -> None:
    """A logarithmic axis of errors."""
    axis._set_axes_scale("log")
    plain_log(axis, narrow)
