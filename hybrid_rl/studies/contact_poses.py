"""Poses of objects by touch: errors over time, and what the absence of contact tells."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.core import poses as moves
from hybrid_rl.studies.contact_maps_picture import marks_of
from hybrid_rl.studies.contacts import GOOD, Trials, errors, found, good, trials
from hybrid_rl.studies.curves import band, iqm, plural
from hybrid_rl.studies.falls import wilson
from hybrid_rl.studies.style import COLOURS, STROKES, legend_below

CELLS = (31, 31, 60)  # of x, y and the angle, in the Bayes filter
KINDS = ("all", "contacts", "absences")


def poses(pattern: str, times: str) -> tuple[Any, dict[str, Any]]:
    """Errors of the mean pose over time, and the share of trials in which it is found."""
    from matplotlib.figure import Figure

    runs = trials(pattern, "pose")
    dt, length = runs[0].world.spec.dt, min(run.y.shape[1] for run in runs)
    marks = marks_of(times, length, dt)
    figure = Figure(figsize=(9, 3.4), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    numbers: dict[str, Any] = {"times": [mark * dt for mark in marks], "methods": {}}
    t = dt * np.arange(1, length + 1)
    for i, run in enumerate(runs):
        position, angle = (each[:, :length] for each in errors(run))
        is_good = good(position, angle)
        line = {"color": COLOURS[i % 7], "linestyle": STROKES[i // 7 % 4], "label": run.label}
        for axes, values in ((left, position), (middle, angle)):
            axes.plot(t, np.median(values, 0), **line)
            quarter = np.percentile(values, [25, 75], axis=0)
            axes.fill_between(t, *quarter, alpha=0.15, color=line["color"])
        first = found(is_good)
        right.plot(t, np.mean(first[:, None] <= np.arange(1, length + 1), 0), **line)
        numbers["methods"][run.label] = _reported(position, angle, is_good, first * dt, marks)
    left.set(title="position error, median and quartiles", xlabel="Time [s]", yscale="log")
    left.set_ylabel("[m]")
    middle.set(title="angle error, median and quartiles", xlabel="Time [s]", yscale="log")
    middle.set_ylabel("[rad]")
    right.set(title=f"found to the end: {GOOD[0]} m, {GOOD[1]} rad", xlabel="Time [s]", ylim=(0, 1))
    legend_below(left)
    return figure, numbers


def _reported(
    position: np.ndarray,
    angle: np.ndarray,
    is_good: np.ndarray,
    first: np.ndarray,
    marks: list[int],
) -> dict[str, Any]:
    """Numbers of one run at each time, over trials."""
    at = np.array(marks) - 1
    counts = is_good[:, at].sum(0)
    return {
        "trials": len(position),
        "position": {"median": np.median(position[:, at], 0), "band": band(position[:, at])},
        "angle": {"median": np.median(angle[:, at], 0), "band": band(angle[:, at])},
        "good": counts,
        "wilson": [wilson(int(count), len(position)) for count in counts],
        "found_at": {"median": np.nanmedian(first) if np.isfinite(first).any() else None},
        "found_each": first,
    }


def lines(numbers: dict[str, Any]) -> list[str]:
    """A line per method at the last time."""
    result = []
    for label, one in numbers["methods"].items():
        low, high = one["wilson"][-1]
        share = f"{one['good'][-1]} good [{100 * low:.0f}%, {100 * high:.0f}%]"
        when = one["found_at"]["median"]
        result.append(
            f"{label}, {plural(one['trials'], 'trial')} of {numbers['times'][-1]:g} s: {share}, "
            f"median {one['position']['median'][-1]:.4f} m, {one['angle']['median'][-1]:.4f} rad, "
            f"found after {'never' if when is None else f'{when:.1f} s'}"
        )
    return result


def absence(pattern: str) -> tuple[Any, dict[str, Any]]:
    """Entropy of the pose over time, by which measurements count."""
    from matplotlib.figure import Figure

    run = trials(pattern, "absence")[0]
    entropies = np.stack([_entropies(run, kind) for kind in KINDS])
    figure = Figure(figsize=(5, 3.4), layout="constrained")
    axes = figure.subplots()
    t = run.world.spec.dt * np.arange(1, entropies.shape[2] + 1)
    numbers: dict[str, Any] = {"trials": entropies.shape[1], "kinds": {}}
    for i, (kind, each) in enumerate(zip(KINDS, entropies, strict=True)):
        low, high = band(each)
        axes.plot(t, iqm(each), color=COLOURS[i], label=kind)
        axes.fill_between(t, low, high, alpha=0.2, color=COLOURS[i])
        last = {"iqm": iqm(each)[-1], "low": low[-1], "high": high[-1], "each": each[:, -1]}
        numbers["kinds"][kind] = last
    less = entropies[2, :, -1] <= entropies[1, :, -1]
    numbers["absences_leave_no_more"] = int(less.sum())
    axes.set(title="entropy of the pose", xlabel="Time [s]", ylabel="[nat]")
    axes.legend()
    return figure, numbers


def _entropies(run: Trials, kind: str) -> np.ndarray:
    """Entropy [S, T] [nat] of the pose on a grid after each measurement of this kind."""
    belief: Any = run.recorded.run.agent.learners["belief"]
    part = belief.belief
    low, high = jnp.array(part.domain.low), jnp.array(part.domain.high)
    axes = [
        a + (b - a) * (jnp.arange(n) + 0.5) / n for a, b, n in zip(low, high, CELLS, strict=False)
    ]
    angles = -jnp.pi + 2 * jnp.pi * (jnp.arange(CELLS[2]) + 0.5) / CELLS[2]
    theta = jnp.stack(jnp.meshgrid(*axes, angles), -1).reshape(-1, 3)
    middle = jnp.array(part.map.middle)
    cell = jnp.log(jnp.prod(high - low) * 2 * jnp.pi / len(theta))

    def one(log_w: jax.Array, measured: Any) -> Any:
        s, y = measured
        p = jax.vmap(lambda theta: part.map.chance(moves.to_map(theta, s, middle)))(theta)
        counts = {"all": True, "contacts": y > 0.5, "absences": y < 0.5}[kind]
        log_w = log_w + jnp.where(counts, jnp.log(jnp.where(y > 0.5, p, 1 - p)), 0.0)
        log_p = jax.nn.log_softmax(log_w)
        return log_w, -jnp.sum(jnp.exp(log_p) * log_p) + cell

    def trial(measured: Any) -> Any:
        return jax.lax.scan(one, jnp.zeros(len(theta)), measured)[1]

    return np.asarray(
        jax.jit(lambda m: jax.lax.map(trial, m))((jnp.asarray(run.s), jnp.asarray(run.y)))
    )


def absence_lines(numbers: dict[str, Any]) -> list[str]:
    """A line per kind, and in how many trials absences leave no more entropy than contacts."""
    result = [
        f"{kind}: {one['iqm']:.2f} [{one['low']:.2f}, {one['high']:.2f}] nat at the end"
        for kind, one in numbers["kinds"].items()
    ]
    less = f"{numbers['absences_leave_no_more']} of {plural(numbers['trials'], 'trial')}"
    return [*result, f"absences alone leave no more entropy than contacts alone in {less}"]
