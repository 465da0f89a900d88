"""Poses of objects by touch: errors over time, and what the absence of contact tells."""

from dataclasses import replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from scipy.special import digamma

from hybrid_rl.analysis.curves import band, plural
from hybrid_rl.analysis.style import (
    GREY,
    blank,
    legend_below,
    legend_outside,
    line_styles,
    plain_log,
)
from hybrid_rl.core import poses as moves
from hybrid_rl.thesis.studies.contact_maps_picture import marks_of
from hybrid_rl.thesis.studies.contacts import (
    Trials,
    errors,
    first,
    found,
    good,
    sign_test,
    stuck,
    trials,
)
from hybrid_rl.thesis.studies.dots import ROW_HEIGHT, dots, row_points
from hybrid_rl.thesis.studies.falls import wilson
from hybrid_rl.thesis.studies.numbers import band_of

KINDS = {  # which measurements y [S, T] count
    "all": lambda y: y >= 0,
    "contacts": lambda y: y > 0.5,
    "absences": lambda y: y < 0.5,
}
COUNTING = {
    "all": "all measurements count",
    "contacts": "contacts alone",
    "absences": "absence of contact alone",
}
AXES = ("x", "y", "angle")
SOME, NEAREST, RHO = 400, 16, 0.3  # particles of an entropy, neighbours; [m]
CLOSEST = 0.003  # [m]
EVERY = 10  # decisions between two entropies


def poses(pattern: str, names: str, times: str) -> tuple[Any, dict[str, Any]]:
    """Errors of the mean pose over time, and the times until it is found."""
    runs = trials(pattern, names)
    dt, length = runs[0].world.spec.dt, min(run.y.shape[1] for run in runs)
    marks = marks_of(times, length, dt)
    numbers: dict[str, Any] = {"times": [mark * dt for mark in marks], "methods": {}}
    rival: dict[str, np.ndarray] = {}
    for i, run in enumerate(runs):
        position, angle = (each[:, :length] for each in errors(run))
        is_good = good(position, angle)
        waits = {"first": dt * first(is_good), "found": dt * found(is_good)}
        one = _reported(run, position, angle, is_good, marks)
        one["lasting"] = [int((waits["found"] <= (mark + 0.5) * dt).sum()) for mark in marks]
        rival = rival or waits
        for name, each in waits.items():
            one[name] = _wait(each)
            if i and run.recorded.run.seeds == runs[0].recorded.run.seeds:
                one[name]["against_first_run"] = sign_test(each, rival[name])
        numbers["methods"][run.label] = one
    return draw_poses(numbers), numbers


def draw_poses(numbers: dict[str, Any]) -> Any:
    """A row for each method: its errors at all times, and each trial's time until found."""
    from matplotlib.ticker import MaxNLocator

    times, methods = numbers["times"], numbers["methods"]
    height = max(2.6, 1.1 + 1.2 * ROW_HEIGHT * len(methods))
    figure = blank(9, height)
    errors, angles, waits = figure.subplots(1, 3, sharey=True, width_ratios=(1, 1, 1.2))
    marks = [f"{time:g} s" for time in times]
    for axes, name, title in (
        (errors, "position", "Position error [m]"),
        (angles, "angle", "Angle error [rad]"),
    ):
        each = {
            label: np.array([one[name]["median"], *one[name]["band"]]).T
            for label, one in methods.items()
        }
        axes.set(title=title, xscale="log")
        row_points(axes, each, marks if axes is errors else ())
        plain_log(axes.xaxis, narrow=True)
    each = {label: np.array(one["found"]["each"], float) for label, one in methods.items()}
    dots(waits, each, times[-1])
    legend_outside(errors)
    waits.xaxis.set_major_locator(MaxNLocator(5))
    waits.set(title="Found after [s], grey: never", xlim=(0, None))
    return figure


def _reported(
    run: Trials, position: np.ndarray, angle: np.ndarray, is_good: np.ndarray, marks: list[int]
) -> dict[str, Any]:
    """Numbers of one run at each time, over trials."""
    at = np.array(marks) - 1
    counts, still = is_good[:, at].sum(0), stuck(run.s[:, : marks[-1]], run.world.spec.dt)
    best = [each[:, at] for each in errors(run, "best")]
    behind = _truth_behind(run, marks[-1])
    return {
        "trials": len(position),
        "position": {"median": np.median(position[:, at], 0), "band": band(position[:, at])},
        "angle": {"median": np.median(angle[:, at], 0), "band": band(angle[:, at])},
        "best": {"position": np.median(best[0], 0), "angle": np.median(best[1], 0)},
        "good": counts,
        "wilson": [wilson(int(count), len(position)) for count in counts],
        "stuck": int(still.sum()),
        "truth_behind": {"median": np.median(behind), "each": behind},
        "each": {"position": position[:, at], "angle": angle[:, at], "stuck": still},
    }


def _wait(each: np.ndarray) -> dict[str, Any]:
    """Median of times [S], and how many trials never got there; they count as infinite."""
    median = np.median(each)
    return {
        "median": median if np.isfinite(median) else None,
        "never": int(np.isinf(each).sum()),
        "each": [one if np.isfinite(one) else None for one in each.tolist()],
    }


def _truth_behind(run: Trials, length: int) -> np.ndarray:
    """log L(best particle) - log L(truth) [S] [nat] of the first `length` measurements."""
    part: Any = run.recorded.run.agent.learners["belief"]
    chance = _chance(part.belief)

    def log_like(theta: jax.Array, s: jax.Array, y: jax.Array) -> jax.Array:
        p = jax.vmap(chance, (None, 0))(theta, s)
        return jnp.sum(jnp.log(jnp.where(y > 0.5, p, 1 - p)))

    def pose(name: str) -> np.ndarray:
        columns = [run.rows[f"{name}_{axis}"][:, length - 1] for axis in AXES]
        return np.stack(columns, -1)

    each = jax.jit(jax.vmap(log_like))
    s, y = run.s[:, :length], run.y[:, :length]
    return np.asarray(each(pose("belief/best"), s, y) - each(pose("world/pose"), s, y))


def _chance(part: Any) -> Any:
    """p(y = 1) of theta [3] and s [2], of a belief about poses."""
    middle = jnp.array(part.map.middle)
    return lambda theta, s: part.map.chance(moves.to_map(theta, s, middle))


def lines(numbers: dict[str, Any]) -> list[str]:
    """A line per method at the last time."""
    result = []
    for label, one in numbers["methods"].items():
        low, high = one["wilson"][-1]
        share = f"{one['good'][-1]} good [{100 * low:.0f}%, {100 * high:.0f}%]"
        when = one["found"]["median"]
        result.append(
            f"{label}, {plural(one['trials'], 'trial')} of {numbers['times'][-1]:g} s: {share}, "
            f"median {one['position']['median'][-1]:.4f} m, {one['angle']['median'][-1]:.4f} rad, "
            f"{'not found' if when is None else f'found after {when:.1f} s'}, "
            f"stuck {one['stuck']}{_against(one)}"
        )
    return result


def _against(one: dict[str, Any]) -> str:
    """The sign test of the time until found, against the first run."""
    test = one["found"].get("against_first_run")
    if test is None:
        return ""
    return (
        f"; sooner than the first in {test['sooner']}, later in {test['later']}, p {test['p']:.3f}"
    )


def absence(pattern: str, times: str) -> tuple[Any, dict[str, Any]]:
    """Entropy of the pose over time, and the error of its mean, by which measurements count."""
    run = trials(pattern)[0]
    errors(run)  # refuses a run without poses
    dt, length = run.world.spec.dt, run.y.shape[1]
    at = np.array(marks_of(times, length, dt)) - 1
    at = np.unique([*range(EVERY - 1, length, EVERY), *at])
    kinds = {}
    filtered = _filter(run)
    for kind, counts in KINDS.items():
        means, theta = filtered(counts(run.y))
        entropy = np.array([[entropy_of(each[j]) for j in at] for each in theta])
        position, angle = (each[:, at] for each in errors(run._replace(rows=means)))
        each = {"each": entropy, "position": position, "angle": angle}
        kinds[kind] = {**band_of(entropy), **each}
    less = np.sum(kinds["absences"]["each"] <= kinds["contacts"]["each"], 0)
    least = _entropy_of_balls(np.full(SOME, CLOSEST))
    head = {"times": dt * (at + 1), "trials": len(run.y), "least_entropy": least}
    numbers = {**head, "kinds": kinds, "absences_leave_no_more": less}
    return draw_absence(numbers), numbers


def draw_absence(numbers: dict[str, Any]) -> Any:
    """Entropy over time by the measurements that count; grey: the least that can be measured."""
    figure = blank(4.4, 3.4)
    axes, styles = figure.subplots(), line_styles(numbers["kinds"])
    for kind, one in numbers["kinds"].items():
        style = styles[kind] | {"marker": None, "label": COUNTING[kind]}
        axes.plot(numbers["times"], one["iqm"], **style)
        ends = one["low"], one["high"]
        axes.fill_between(numbers["times"], *ends, alpha=0.2, color=style["color"], lw=0)
    axes.axhline(numbers["least_entropy"], color=GREY, linestyle="--", linewidth=0.8)
    axes.set(title="Entropy of the pose [nat]", xlabel="Time [s]")
    legend_below(axes)
    return figure


def entropy_of(theta: np.ndarray) -> float:
    """Entropy [nat] of the density of poses theta [M, 3], by their NEAREST neighbours.

    Kozachenko and Leonenko 1987, with angles as lengths, rho = 0.3 m. Resampled particles may be
    equal, so that neighbours are many, and the radius around them is at least CLOSEST.
    """
    apart = theta[:, None] - theta[None]
    apart[..., 2] = RHO * ((apart[..., 2] + np.pi) % (2 * np.pi) - np.pi)
    radius = np.partition(np.linalg.norm(apart, axis=-1), NEAREST, 1)[:, NEAREST]
    return _entropy_of_balls(np.maximum(radius, CLOSEST))


def _entropy_of_balls(radius: np.ndarray) -> float:
    """Entropy [nat] if balls of these radii [M] around M poses hold NEAREST others each."""
    ball = np.log(4 / 3 * np.pi) + 3 * np.log(radius).mean()
    return float(digamma(len(radius)) - digamma(NEAREST) + ball - np.log(RHO))


def _filter(run: Trials) -> Any:
    """What the run's belief about poses holds if only some measurements count, [S, T].

    Returns:
        A function of which ones: its mean [S, T] in rows, and some particles [S, T, SOME, 3].
    """
    learner: Any = run.recorded.run.agent.learners["belief"]
    belief = replace(learner.belief, kind="metropolis")

    def one(state: Any, measured: Any) -> Any:
        s, y, counts, key = measured
        after = belief.add(state, s, y, key)
        state = jax.tree.map(lambda new, old: jnp.where(counts, new, old), after, state)
        report = belief.report(state)
        mean = jnp.stack([report[f"belief/mean_{axis}"] for axis in AXES])
        drawn = moves.systematic(state.log_w, SOME, jnp.float32(0.5))
        return state, (mean, state.theta[drawn])

    @jax.jit
    @jax.vmap
    def trial(key: jax.Array, s: jax.Array, y: jax.Array, counts: jax.Array) -> Any:
        first, adding = jax.random.split(key)
        state = belief.init(first, run.recorded.run.agent.spec)
        return jax.lax.scan(one, state, (s, y, counts, jax.random.split(adding, len(y))))[1]

    def filtered(counts: np.ndarray) -> tuple[dict[str, np.ndarray], np.ndarray]:
        keys = jax.random.split(jax.random.key(0), len(run.y))
        mean, theta = trial(keys, run.s, run.y, counts)
        means = {f"belief/mean_{axis}": np.asarray(mean[..., i]) for i, axis in enumerate(AXES)}
        return {**run.rows, **means}, np.asarray(theta)

    return filtered


def absence_lines(numbers: dict[str, Any]) -> list[str]:
    """A line per kind, and in how many trials absences leave no more entropy than contacts."""
    result = [
        f"{kind}: {one['iqm'][-1]:.2f} [{one['low'][-1]:.2f}, {one['high'][-1]:.2f}] nat, "
        f"{np.median(np.asarray(one['position'])[:, -1]):.3f} m off (median)"
        for kind, one in numbers["kinds"].items()
    ]
    less = f"{numbers['absences_leave_no_more'][-1]} of {plural(numbers['trials'], 'trial')}"
    end = f"after {numbers['times'][-1]:g} s"
    return [*result, f"{end} absences alone leave no more entropy than contacts alone in {less}"]
