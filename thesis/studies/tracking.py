"""Robots that follow a reference by a Koopman operator: figures 7-6 and 7-7.

    RMSE         root mean square distance of the robot (Sawyer: its tip) to the reference
    correlation  Pearson's, of each coordinate that the reference moves
    lag          argmax_l of the correlation of p(t + l) with p_ref(t), over all coordinates at
                 once; a parabola refines it between decisions; + is late
    lost         trials whose RMSE is no less than that of the point in the middle of the path

The decisions of the exploration (`env.learn`) and one second of the path are left out. The variance
of the noise of an observed position is subtracted from the mean square of its distance. A trial
without a lag within 0.5 s has none.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.analysis.curves import plural
from hybrid_rl.analysis.results import find
from hybrid_rl.analysis.style import (
    blank,
    legend_below,
    line_styles,
    plain_log,
    words,
)
from hybrid_rl.envs.mujoco.kinematics import Chain
from hybrid_rl.errors import UsageError
from hybrid_rl.thesis.studies.dots import ROW_HEIGHT, row_points
from hybrid_rl.thesis.studies.numbers import banded
from hybrid_rl.thesis.studies.recorded import Recorded, labels, one_episode, read

LEFT_OUT = 1.0  # [s] of the path
FURTHEST = 0.5  # [s] largest lag
LEAST = 1e-3  # [m] standard deviation of a coordinate that moves
MEASURES = {  # name -> (words, unit)
    "rmse_mm": ("RMSE", "mm"),
    "lag_ms": ("lag", "ms"),
    "rms_action": ("rms action", ""),
    "greatest_rate": ("greatest rate while learning", ""),
}


class Robot(NamedTuple):
    """How the observations of a task are read."""

    position: Callable[[Array], Array]  # obs [o] -> p [d] [m]
    rates: slice  # of the joints or of the ball, in an observation
    noisy: bool  # whether env.sensor_noise is that of the position


ROBOTS = {
    "sprk_sand": Robot(lambda obs: obs[:2], slice(2, 4), True),
    "sawyer_torque": Robot(
        lambda obs: Chain("sawyer_torque.xml", "tip").pose(obs[:7])[0], slice(7, 14), False
    ),
}


class Track(NamedTuple):
    """The paths of one method: S trials of T decisions after the exploration."""

    label: str
    position: np.ndarray  # [S, T, d] [m]
    reference: np.ndarray  # [S, T, d] [m]
    action: np.ndarray  # [S, T, m]
    greatest_rate: np.ndarray  # [S] before it
    noise: float  # [m] standard deviation of each coordinate
    dt: float


def tracking(pattern: str) -> tuple[Any, dict[str, Any]]:
    """Paths of the first trial, RMSE and lag of each method."""
    folders = find(pattern)
    runs = [read(folder, *ROBOTS) for folder in folders]
    tasks = {run.config.task for run in runs}
    if len(tasks) > 1:
        raise UsageError(f"runs={pattern}: has runs of {' and '.join(sorted(tasks))}; give one")
    tracks = [of(run, label) for run, label in zip(runs, labels(folders), strict=True)]
    numbers = {track.label: reported(track) for track in tracks}
    made = {"task": tasks.pop(), "methods": numbers}
    return draw(made, tracks), made


def of(recorded: Recorded, label: str) -> Track:
    """The paths of a run."""
    world, dt = recorded.run.agent.episode.env, recorded.run.agent.spec.dt
    robot, made = ROBOTS[recorded.config.task], one_episode(recorded)
    begin = world.learn + round(LEFT_OUT / dt)
    if begin + 2 * round(FURTHEST / dt) + 3 > recorded.decisions:
        raise UsageError(
            f"runs={recorded.folder.path}: {recorded.decisions} decisions end before the path; "
            "train with a larger total_steps or a smaller env.learn"
        )
    obs = jnp.asarray(made.obs[:, begin:])

    def both(obs: Array) -> tuple[Array, Array]:
        return robot.position(obs), robot.position(world.reference(obs)[0])

    position, reference = jax.jit(jax.vmap(jax.vmap(both)))(obs)
    rates = np.abs(made.obs[:, : max(world.learn, 1), robot.rates]).max((1, 2))
    noise = world.sensor_noise if robot.noisy else 0.0
    paths = np.asarray(position, float), np.asarray(reference, float)
    return Track(label, *paths, made.action[:, begin:], rates, noise, dt)


def rmse(position: np.ndarray, reference: np.ndarray, noise: float = 0.0) -> np.ndarray:
    """[S] of paths [S, T, d], in their unit; noise: std of each observed coordinate."""
    square = ((position - reference) ** 2).sum(-1).mean(1)
    return np.sqrt(np.maximum(square - position.shape[-1] * noise**2, 0))


def correlation(position: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """[S, d] Pearson's of paths [S, T, d]; NaN for a coordinate in which nothing moves."""
    a, b = (path - path.mean(1, keepdims=True) for path in (position, reference))
    scale = np.sqrt((a**2).sum(1) * (b**2).sum(1))
    moves = b.std(1) > LEAST
    return np.where(moves, (a * b).sum(1) / np.where(moves, scale, 1), np.nan)


def lag(position: np.ndarray, reference: np.ndarray, dt: float) -> float:
    """[s] by which a path [T, d] is late; NaN without a peak within FURTHEST."""
    most = round(FURTHEST / dt)
    length = len(reference) - 2 * most
    still = reference[most : most + length]
    still = still - still.mean(0)

    def match(shift: int) -> float:
        moved = position[most + shift : most + shift + length]
        moved = moved - moved.mean(0)
        scale = np.sqrt((still**2).sum() * (moved**2).sum())
        return float((still * moved).sum() / scale) if scale > 0 else np.nan

    values = np.array([match(shift) for shift in range(-most, most + 1)])
    if not np.isfinite(values).all():
        return np.nan
    peak = int(np.argmax(values))
    if peak in (0, 2 * most):
        return np.nan
    before, top, after = values[peak - 1 : peak + 2]
    return dt * (peak - most + 0.5 * (before - after) / (before - 2 * top + after))


def reported(track: Track) -> dict[str, Any]:
    """The numbers of one method: values of each trial, and IQM with its band."""
    pairs = list(zip(track.position, track.reference, strict=True))
    each = {
        "rmse_mm": 1e3 * rmse(track.position, track.reference, track.noise),
        "lag_ms": 1e3 * np.array([lag(p, r, track.dt) for p, r in pairs]),
        "rms_action": np.sqrt((track.action.astype(float) ** 2).mean((1, 2))),
        "greatest_rate": track.greatest_rate.astype(float),
    }
    numbers: dict[str, Any] = {"trials": len(pairs)}
    for name, values in each.items():
        numbers[name] = _spread(values)
        numbers[f"{name}_of_trials"] = values
    still = 1e3 * track.reference.std(1)
    numbers["lost"] = int((each["rmse_mm"] >= np.linalg.norm(still, axis=-1)).sum())
    numbers["median_rmse_mm"] = np.median(each["rmse_mm"])
    pearson = correlation(track.position, track.reference)
    numbers["correlation"] = [_spread(column) for column in pearson.T]
    return numbers


def _spread(values: np.ndarray) -> list[float] | None:
    """IQM and its band over the trials that have a value; None: no trial has one."""
    known = values[np.isfinite(values)]
    return banded(known) if len(known) else None


def lines(numbers: dict[str, Any]) -> list[str]:
    """A line for each method."""
    result = []
    for label, one in numbers["methods"].items():
        parts = []
        for name, (title, unit) in MEASURES.items():
            if one[name] is None:
                continue
            middle, low, high = one[name]
            parts.append(f"{title} {middle:.3g} [{low:.3g}, {high:.3g}] {unit}".strip())
        moving = [f"{each[0]:.4f}" for each in one["correlation"] if each is not None]
        parts.append(f"correlation {', '.join(moving)}")
        trials = f"{plural(one['trials'], 'trial')}, {one['lost']} lost"
        result.append(f"{label}, {trials}: {', '.join(parts)}")
    return result


def draw(numbers: dict[str, Any], tracks: Sequence[Track] = ()) -> Any:
    """RMSE and lag of each method, and below them the paths of the first trial, if there are."""
    methods = numbers["methods"]
    heights = [0.9 + ROW_HEIGHT * len(methods), *([4.0] if tracks else [])]
    figure = blank(9, sum(heights))
    parts: Any = figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False)[:, 0]
    errors, lags = parts[0].subplots(1, 2, sharey=True)
    entries = [f"{words(x)} ({plural(int(one['trials']), 'trial')})" for x, one in methods.items()]
    for axes, name in ((errors, "rmse_mm"), (lags, "lag_ms")):
        none = [np.nan] * 3
        each = {x: [none if one[name] is None else one[name]] for x, one in methods.items()}
        row_points(axes, each, entries=entries)
    errors.set(title="RMSE [mm], IQM and 95% band", xscale="log")
    plain_log(errors.xaxis, narrow=True)
    lags.set_title("Lag [ms], + is late")
    lags.axvline(0, color="k", lw=0.6)
    if tracks:
        _paths(parts[1].subplots(), tracks)
    return figure


def _paths(plane: Any, tracks: Sequence[Track]) -> None:
    """The first trial of each method over the reference, in the plane in which it moves."""
    spread, styles = tracks[0].reference[0].std(0), line_styles([track.label for track in tracks])
    i, j = sorted(np.argsort(-spread)[:2])
    names = "xyz"
    plane.plot(*tracks[0].reference[0][:, [i, j]].T, color="k", lw=2.5, alpha=0.3, label="path")
    for track in tracks:
        style = styles[track.label] | {"marker": None, "label": words(track.label)}
        plane.plot(*track.position[0][:, [i, j]].T, lw=0.9, **style)
    plane.set(xlabel=f"{names[i]} [m]", ylabel=f"{names[j]} [m]", title="First trial")
    plane.set_aspect("equal", adjustable="datalim")
    legend_below(plane)
