"""Flights as pictures: what they did, what they cost, how well models learned from them fly."""

from typing import Any

import numpy as np

from hybrid_rl.studies.curves import band, iqm
from hybrid_rl.studies.style import COLOURS, ENTRY, STROKES, STYLE, legend_below, plain_log

EXACT = "exact model"
VELOCITIES = ((slice(12, 15), "v [m/s]"), (slice(15, 18), "w [rad/s]"))  # of an observation


def signals(flights: list[Any], dt: float) -> Any:
    """Actions and velocities of the first trial of each method."""
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(2.2 * max(3, len(flights)), 4), layout="constrained")
        panels: Any = figure.subplots(3, len(flights), squeeze=False, sharex=True, sharey="row")
        for i, flight in enumerate(flights):
            t, x = dt * np.arange(flight.obs.shape[1]), flight.obs[0]
            panels[0][i].plot(t, np.linalg.norm(flight.action[0], axis=-1), lw=0.6, color="k")
            for panel, (entries, _) in zip(panels[1:, i], VELOCITIES, strict=True):
                panel.plot(t, x[:, entries], lw=0.8)
            panels[0][i].set_title(named(flight.label).replace(", ", "\n"), fontsize=8)
            panels[2][i].set_xlabel("Time [s]")
        names = ("|u|", *(name for _, name in VELOCITIES))
        for row, name in zip(panels, names, strict=True):
            row[0].set_ylabel(name)
    return figure


def named(label: str, trials: int = 0) -> str:
    """A label in words: "ou_noise 0.1" is "ou_noise, level 0.1", with the number of trials."""
    algo, *rest = label.split()
    words = algo if label != EXACT else label
    if label != EXACT:
        words += f", {'level' if algo.endswith('noise') else 'gain'} {' '.join(rest)}"
    return f"{words} ({trials} trial{'s' * (trials != 1)})" if trials else words


def outcome(found: dict[str, Any], dt: float) -> Any:
    """How models track over time; and their error and tracking over what their flights cost."""
    import matplotlib
    from matplotlib.figure import Figure

    methods = sorted({label.split()[0] for label in found if label != EXACT})
    of = {name: [la for la in found if la.split()[0] == name and la != EXACT] for name in methods}
    colours = dict(zip(methods, COLOURS, strict=False))
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(13, 4.2 + ENTRY * len(found)), layout="constrained")
        over_time, wrong, tracks = figure.subplots(1, 3)
        _over_time(over_time, found, EXACT, "k", "-", dt)
        for name in methods:
            for i, label in enumerate(of[name]):
                _over_time(over_time, found, label, colours[name], STROKES[i % len(STROKES)], dt)
            _over_cost(wrong, name, [(found[la], found[la]["error"]) for la in of[name]], colours)
            tracking = [(found[label], found[label]["distance"].mean(1)) for label in of[name]]
            _over_cost(tracks, name, tracking, colours)
        exact = iqm(found[EXACT]["distance"].mean(1))
        tracks.axhline(exact, color="k", lw=0.8, label=EXACT)
        over_time.set(
            xlim=(0, None), xlabel="Time [s]", title="Distance to the target [m]", yscale="log"
        )
        plain_log(over_time.yaxis)
        wrong.set(title="Error of one decision")
        tracks.set(title="Mean distance to the target [m]")
        for axes in (wrong, tracks):
            axes.set(xlabel="Power loss of the flight [N]", xscale="log", yscale="log")
            axes.margins(0.12)
            plain_log(axes.xaxis)
            plain_log(axes.yaxis)
        for axes in (over_time, wrong, tracks):
            legend_below(axes)
    return figure


def _over_time(axes: Any, found: dict, label: str, colour: str, stroke: str, dt: float) -> None:
    """Distance to the target of all trials of one method."""
    each = found[label]["distance"][:, ::10]
    t, (low, high) = 10 * dt * np.arange(each.shape[1]), band(each, 500)
    marker = "o" if len(t) == 1 else None
    shown = named(label, len(each))
    axes.plot(t, iqm(each), color=colour, linestyle=stroke, marker=marker, label=shown)
    axes.fill_between(t, low, high, color=colour, alpha=0.12, lw=0)


def _over_cost(axes: Any, name: str, each: list[tuple[dict, np.ndarray]], colours: dict) -> None:
    """IQM and band of trials [S] of each setting of a method, over what its flights cost."""
    points = sorted(((cost["power_loss"].mean(), values) for cost, values in each), key=_first)
    middle = np.array([iqm(values) for _, values in points])
    ends = np.abs(np.array([band(values) for _, values in points]).T - middle[None])
    power = [at for at, _ in points]
    axes.errorbar(power, middle, ends, color=colours[name], marker="o", ms=4, label=name)


def _first(pair: tuple[float, Any]) -> float:
    return pair[0]
