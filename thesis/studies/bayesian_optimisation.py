"""Bayesian optimisation with dynamics: best value, Lyapunov function and measurements.

    python -m hybrid_rl.figures study=bayesian_optimisation runs="runs/*/*bayesopt/*"

Figures 6-3 to 6-5. Best value over measurements and the Lyapunov function V over time, median and
range over trials; and the measurements of the first trial of each method. The summary has the best
value, how many trials get above 95% of the highest hill (1.0), after how many measurements, and the
greatest V, as interquartile mean and 95% band over trials. group=full.level compares levels of
the guard instead of methods.
"""

from pathlib import Path
from typing import Annotated, Any

import numpy as np

from hybrid_rl.analysis.curves import Curve, curves, plural, spread
from hybrid_rl.analysis.style import (
    ENTRY,
    NOTE_WIDTH,
    blank,
    colours,
    legend_below,
    plain_log,
    words,
    wrapped,
    write_notes,
)

BEST, V, POSITION, VALUE = "belief/best", "planner/lyapunov", "belief/position", "belief/value"
FEW = 10  # points up to which each has a marker
MARKS = (10, 20, 40, 60, 80)  # measurements after which the best value is reported
REACHED = 0.95  # of the highest hill


def figure(
    runs: Annotated[str, 'run folders, as "runs/*/*bayesopt/*" in quotes'],
    group: Annotated[str, "key of the configuration, with a curve for each value"] = "algo",
) -> tuple[Any, dict[str, Any]]:
    """Best values and V of each method, and the measurements of its first trial."""
    from matplotlib.ticker import MaxNLocator

    by_metric = {
        metric: {curve.label: curve for curve in curves(runs, metric, group=group)}
        for metric in (BEST, V, POSITION, VALUE)
    }
    best, lyapunov = by_metric[BEST], by_metric[V]
    numbers = {name: reported(curve, lyapunov.get(name)) for name, curve in best.items()}
    notes = wrapped([note for one in numbers.values() for note in one["notes"]], 2 * NOTE_WIDTH)
    own = colours(best)
    heights = (3.2 + ENTRY * len(best), 1.9 * len(best) + ENTRY * len(notes))
    figure = blank(9, sum(heights))
    halves: Any = figure.subfigures(2, 1, height_ratios=heights)
    above, below = halves
    values, energies = above.subplots(1, 2)
    panels = below.subplots(len(best), 2, squeeze=False)
    for (name, curve), pair in zip(best.items(), panels, strict=True):
        count = np.arange(1, curve.each.shape[1] + 1)
        _band(values, count, curve.each, name, own[name])
        _measurements(pair, by_metric[POSITION][name].each[0], by_metric[VALUE][name].each[0])
        pair[0].set(title=f"{words(name)}: measurements, late ones light")
        pair[1].set(title=f"{words(name)}: coordinate of each")
    for name, curve in lyapunov.items():
        _band(energies, _seconds(curve), curve.each, name, own[name])
    values.set(xlabel="Measurements", title="Best value")
    energies.set(xlabel="Time [s]", title="Lyapunov function V", yscale="log")
    plain_log(energies.yaxis)
    for axes in (values, *panels[:, 1]):
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    for axes in (values, energies):
        legend_below(axes)
    write_notes(below, notes)
    return figure, numbers


def summary(numbers: dict[str, Any]) -> list[str]:
    """A line per method; then the notes."""
    lines = []
    for name, one in numbers.items():
        trials, counts = one["trials"], one["measurements_to_95_percent"]
        reached = [count for count in counts if count is not None]
        measurements = max(map(int, one["median_best_after"]))
        parts = [
            f"best value {spread(np.array(one['best']))} after {measurements}",
            f"above 95% in {len(reached)} of {trials}",
        ]
        if reached:
            parts[-1] += f", after {np.median(reached):g} measurements (median)"
        if "V_peak" in one:
            parts.append(f"greatest V {spread(np.array(one['V_peak']))}")
        lines.append(f"{name}, {plural(trials, 'trial')}: {'; '.join(parts)}")
    notes = [f"note: {note}" for one in numbers.values() for note in one.get("notes", ())]
    return lines + list(dict.fromkeys(notes))


def reported(best: Curve, lyapunov: Curve | None) -> dict[str, Any]:
    """The numbers of one method, from its best values [S, G] and V [S, T] of all trials."""
    each = best.each
    marks = [n for n in (*MARKS, each.shape[1]) if n <= each.shape[1]]
    numbers: dict[str, Any] = {
        "trials": len(each),
        "median_best_after": {n: round(float(np.nanmedian(each[:, n - 1])), 4) for n in marks},
        "measurements_to_95_percent": [
            int(np.argmax(one > REACHED)) + 1 if np.nanmax(one) > REACHED else None for one in each
        ],
        "best": [round(float(value), 4) for value in np.nanmax(each, 1)],
        "notes": list(best.notes),
    }
    if lyapunov:
        numbers["V_peak"] = [round(float(peak), 1) for peak in np.nanmax(lyapunov.each, 1)]
        numbers["V_median"] = round(float(np.nanmedian(lyapunov.each)), 2)
        numbers["notes"] = list(dict.fromkeys([*best.notes, *lyapunov.notes]))
    return numbers


def _seconds(curve: Curve) -> np.ndarray:
    """Time [s] of a curve's points."""
    from hybrid_rl.run.folder import parse_config
    from hybrid_rl.settings.build import build

    return curve.x * build(parse_config(Path(curve.runs[0]))).agent.spec.dt


def _band(axes: Any, x: np.ndarray, each: np.ndarray, name: str, colour: str) -> None:
    """Median and range of each [S, G] over trials; few points are markers."""
    label = f"{words(name)} ({plural(len(each), 'trial')})"
    marker = "o" if len(x) <= FEW else None
    axes.plot(x, np.nanmedian(each, 0), color=colour, marker=marker, ms=4, label=label)
    low, high = np.nanmin(each, 0), np.nanmax(each, 0)
    axes.fill_between(x, low, high, color=colour, alpha=0.15, lw=0)
    if len(x) == 1:  # a band has no width there
        axes.vlines(x, low, high, color=colour, lw=1)


def _measurements(pair: Any, s: np.ndarray, y: np.ndarray) -> None:
    """One trial in two panels: values y [G] over coordinate s [G], and coordinate over number."""
    count, few = np.arange(1, len(s) + 1), len(s) <= FEW
    pair[0].scatter(s, y, c=count, s=30 if few else 8, cmap="viridis")
    pair[0].set(xlim=(-1, 1), ylim=(0, 1.1))
    pair[1].plot(count, s, ".-", lw=0.6, ms=8 if few else 3)
    pair[1].set(ylim=(-1, 1))
