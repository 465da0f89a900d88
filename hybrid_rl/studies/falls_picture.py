"""Pictures of falling quadcopters: information, errors, and one trial as a strip."""

from typing import Any

import jax
import numpy as np

from hybrid_rl.envs.analytic.quadcopter_se3 import DT, QuadcopterSE3
from hybrid_rl.envs.analytic.state import fully_observed
from hybrid_rl.errors import UsageError
from hybrid_rl.studies.curves import plural
from hybrid_rl.studies.falls import (
    FIRST,
    STILL,
    Fall,
    falls,
    log_det,
    regressors,
    reported,
    settled,
    trace,
)
from hybrid_rl.studies.style import COLOURS, STROKES, legend_below, plain_log, thousands

TILES = (0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0)  # [s]
HEIGHT, WIDTH, CROP = 480, 640, 150  # [pixels] of a tile before it is cut to a square around it
EVERY = 5  # decisions between two points of a line
LOWEST = 1e-4  # of the errors' axis


def information(pattern: str, strips: str) -> tuple[Any, dict[str, Any]]:
    """Figure 7-2: information, error, share at rest, and strips of some methods' first trials."""
    from matplotlib.ticker import FuncFormatter

    each = falls(pattern, "falls")
    chosen = [_of(name, each) for name in strips.split(",") if name]
    figure, (traces, determinants, errors, shares), below = _panels(len(chosen))
    numbers = {}
    for i, fall in enumerate(each):
        s = regressors(fall)
        numbers[fall.label] = reported(fall, s)
        line = _line(i, fall)
        counts = np.arange(EVERY, round(FIRST / DT) + 1, EVERY)
        traces.plot(DT * counts, np.median(trace(s)[:, counts - 1], axis=0), **line)
        volumes = [np.median(log_det(s[:, :count])) for count in counts]
        determinants.plot(DT * counts, volumes, **line)
        _errors(errors, fall, line)
        _at_rest(shares, fall, line)
    traces.set(xlabel="Time [s]", title="Trace of the information, median")
    determinants.set(xlabel="Time [s]", title="Its log det, median")
    traces.yaxis.set_major_formatter(FuncFormatter(thousands))
    _finish(traces, determinants, errors, shares)
    for part, fall in zip(below, chosen, strict=True):
        _strip(part, fall)
    return figure, {"methods": numbers}


def initial(pattern: str) -> tuple[Any, dict[str, Any]]:
    """Figure 7-3: error and share at rest by the first K."""
    each = falls(pattern, "initial")
    figure, (left, right), _ = _panels(0, across=2)
    numbers = {}
    for i, fall in enumerate(each):
        numbers[fall.label] = reported(fall, regressors(fall))
        _errors(left, fall, _line(i, fall))
        _at_rest(right, fall, _line(i, fall))
    _finish(left, right)
    return figure, {"methods": numbers}


def _of(name: str, each: list[Fall]) -> Fall:
    """The first method whose label begins with the name."""
    found = [fall for fall in each if fall.label.startswith(name)]
    if not found:
        known = ", ".join(fall.label for fall in each)
        raise UsageError(f"strips={name}: not among these runs; they are {known}")
    return found[0]


def _panels(strips: int, across: int = 4) -> tuple[Any, Any, Any]:
    """A figure, its panels, and a subfigure below them for each strip."""
    from matplotlib.figure import Figure

    heights = (4.2, *[1.4 * across / 3] * strips)
    figure = Figure(figsize=(3.5 * across, sum(heights)), layout="constrained")
    if not strips:
        return figure, figure.subplots(1, across), []
    parts: Any = figure.subfigures(1 + strips, 1, height_ratios=heights)
    return figure, parts[0].subplots(1, across), parts[1:]


def _line(i: int, fall: Fall) -> dict[str, Any]:
    """Colour, stroke and label of a line."""
    stroke = STROKES[i // len(COLOURS) % len(STROKES)]
    label = f"{fall.label} ({plural(len(fall.obs), 'trial')})"
    return {"color": COLOURS[i % len(COLOURS)], "linestyle": stroke, "label": label}


def _errors(axes: Any, fall: Fall, line: dict[str, Any]) -> None:
    """Median and 10 to 90% of the errors over time."""
    low, middle, high = np.nanquantile(fall.error[:, ::EVERY], [0.1, 0.5, 0.9], axis=0)
    time = EVERY * DT * np.arange(len(middle))
    axes.plot(time, middle, **line)
    axes.fill_between(time, low, high, color=line["color"], alpha=0.1, lw=0)


def _at_rest(axes: Any, fall: Fall, line: dict[str, Any]) -> None:
    """The share of trials that are at rest from a time on."""
    times = DT * np.arange(fall.error.shape[1])
    share = (DT * settled(fall.error)[:, None] <= times[None] + 1e-9).mean(0)
    axes.plot(times, 100 * share, **line)


def _finish(*panels: Any) -> None:
    """Axes of the errors, which are last but one, and of the shares, which are last."""
    errors, shares = panels[-2:]
    errors.set(xlabel="Time [s]", title="|v|² + |w|², median and 10 to 90%", yscale="log")
    errors.axhline(STILL, color="k", lw=0.6)
    errors.set_ylim(LOWEST, None)
    plain_log(errors.yaxis)
    shares.set(xlabel="Time [s]", title="Trials at rest from then on [%]", ylim=(-2, 102))
    for axes in panels:
        legend_below(axes)


def _strip(part: Any, fall: Fall) -> None:
    """Tiles of the first trial: its attitude, drawn at the origin."""
    from hybrid_rl.run.drawing import frames

    world = QuadcopterSE3()
    at = [min(round(t / DT), fall.obs.shape[1] - 1) for t in TILES]
    seen = fall.obs[0, at]
    still = np.concatenate([0 * seen[:, :3], seen[:, 3:]], axis=1)
    pose = jax.vmap(lambda x: world.pose(fully_observed(x, x[0])))
    pictures = frames(world.scene(), np.asarray(pose(still)), WIDTH, HEIGHT)
    middle, half = (HEIGHT // 2, WIDTH // 2), CROP // 2
    cut = tuple(slice(c - half, c + half) for c in middle)
    part.suptitle(fall.label, fontsize=9, x=0.01, ha="left")
    for axes, picture, t, x in zip(
        part.subplots(1, len(TILES)), pictures, TILES, seen, strict=True
    ):
        axes.imshow(picture[cut])
        axes.set(title=f"{t:g} s, {thousands(round(float(x[2]), 1))} m", xticks=[], yticks=[])
        axes.title.set_fontsize(8)
        axes.grid(False)
