"""Three regulators of Van der Pol's oscillator, from samples of it: figure 7-1.

Koopman     regulator of z' = A z + B u, fitted to the samples
known       regulator of the oscillator's exact linearisation at the origin
regression  regulator of the linearisation at the origin of x' fitted on the same functions
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.analysis.style import BLACK, BLUE, GREY, VERMILION, blank, legend_below, plain_log
from hybrid_rl.core import riccati
from hybrid_rl.core.riccati import at_equilibrium, linearise
from hybrid_rl.envs.analytic.van_der_pol import FORCE
from hybrid_rl.settings.build import Run, build, load
from hybrid_rl.thesis.studies.optimal_path import cost, optimal
from hybrid_rl.thesis.studies.unseen import transitions
from hybrid_rl.types import Params

REGULATORS = ("Koopman", "known", "regression")
OWN = (VERMILION, BLACK, BLUE)  # their colours
HORIZONS = (50, 100, 200, 400)  # T_L [decisions]
SHOWN = 100  # T_L of the paths in the picture
# Largest |x_i| of the samples and of the starts; our choice.
INSIDE = (2.5, 2.0)
RANGES = ((1.0, 2.0), INSIDE, (4.0, 2.0), (4.0, 4.0))
LARGEST_U = 5.0  # of the samples, in units of the thesis
STEPS = 1000  # decisions of a path, 10 s
PATHS = 6  # in the phase plane


class Outcome(NamedTuple):
    """What a path cost."""

    cost: Array  # [] mean of x'Qx + u'Ru over time, times the time [s]
    error: Array  # [] integral of |x| [s]
    clipped: Array  # [] share of the actions that were clipped


def control(samples: int, draws: int, starts: int) -> tuple[Any, dict[str, Any]]:
    """Ratios of cost and error to the known system's regulator, by horizon and by data."""
    run = build(load(["experiment=thesis/fig_7_1"]))
    dt = run.agent.spec.dt
    to_gains = jax.jit(partial(all_gains, run))
    roll_all = jax.jit(jax.vmap(jax.vmap(partial(roll, run), (None, 0)), (0, None)))
    optima = {away: bound(run, _starts(starts, away)) for _, away in RANGES}
    by_data, paths, rates = {}, {}, {}
    for pair in RANGES:
        largest, away = pair
        models = fits(run, samples, draws, largest)
        F = to_gains(models)  # [draws, horizons, regulators, n]
        results = roll_all(F.reshape(-1, F.shape[-1]), _starts(starts, away))
        outcome, x = _split(results, F.shape[:3])
        name = f"{largest:g}, starts {away:g}"
        by_data[name] = reported(outcome, optima[away])
        paths[pair] = x[0, HORIZONS.index(SHOWN)]
        rates[name] = _rates(np.asarray(models["K"])[:, :, : F.shape[-1]], dt)
        print(f"samples within {name}: done", flush=True)
    sizes = {"samples": samples, "draws": draws, "starts": starts, "horizons": HORIZONS}
    numbers = {**sizes, "by_data": by_data, "rates_of_A": rates}
    return _picture(numbers, paths[INSIDE], dt), numbers


def _split(tree: Any, sizes: tuple[int, ...]) -> Any:
    """The first axis of all arrays in axes of these sizes, in NumPy."""
    return jax.tree.map(lambda v: np.asarray(v).reshape(*sizes, *v.shape[1:]), tree)


def _rates(A: np.ndarray, dt: float) -> dict[str, np.ndarray]:
    """log(eigenvalues) / dt [1/s] of A [draws, n, n]: parts [draws, n], fastest growth first."""
    values = np.log(np.linalg.eigvals(A).astype(complex)) / dt
    values = np.take_along_axis(values, np.argsort(-values.real, 1), 1)
    return {"real": values.real, "imaginary": values.imag}


def lines(numbers: dict[str, Any]) -> list[str]:
    """A line for each horizon and each set of data."""
    result = []
    for data, horizons in numbers["by_data"].items():
        for horizon, one in horizons.items():
            parts = []
            for name in ("Koopman", "regression"):
                each = one[name]
                parts.append(
                    f"{name} cost {_spread(each['cost'])}, error {_spread(each['error'])}, "
                    f"less error in {np.median(each['less_error']):g} of {numbers['starts']}"
                )
            parts.append(f"optimum {one['optimum']:.3f}, clipped {max(one['clipped']):.1%}")
            result.append(f"samples within {data}, T_L {horizon}: {'; '.join(parts)}")
    return result


def fits(run: Run, samples: int, draws: int, largest: float) -> Any:
    """Parameters of the model [draws, ...], fitted to uniform samples: |x_i| <= `largest`."""
    world, learner = run.agent.episode.env, run.agent.learners["model"]

    def one(key: Array) -> Any:
        first, for_x, for_u = jax.random.split(key, 3)
        spec = run.agent.spec
        x = jax.random.uniform(for_x, (samples, spec.obs), minval=-largest, maxval=largest)
        u = jax.random.uniform(for_u, (samples, spec.act), minval=-1.0) * LARGEST_U / FORCE
        return fit(learner, spec, x, u, jax.vmap(world.dynamics)(x, u), first)

    return jax.jit(jax.vmap(one))(jax.vmap(jax.random.key)(jnp.arange(draws)))


def fit(learner: Any, spec: Any, x: Array, u: Array, after: Array, key: Array) -> Any:
    """The model's parameters after one update with all samples [B]. The key is consumed."""
    batch = transitions(x, u, after)
    first, updating = jax.random.split(key)
    state = learner.init(first, spec)
    state, _ = learner.update(state, Params(decisions=jnp.zeros(())), batch, updating)
    return learner.params(state)["model"]


def all_gains(run: Run, models: Any) -> Array:
    """F [draws, horizons, regulators, n] of all models."""
    world: Any = run.agent.episode.env
    solver: Any = run.agent.learners["policy"]
    linear = at_equilibrium(world)

    def one(model: Any) -> Array:
        each = [gains(replace(solver, horizon=T), linear, run.agent.spec, model) for T in HORIZONS]
        return jnp.stack(each)

    return jax.vmap(one)(models)


def gains(solver: Any, linear: tuple[np.ndarray, np.ndarray], spec: Any, params: Any) -> Array:
    """F [3, n] of the three regulators of a world with one action, whose goal is the origin.

    linear: A [o, o] and B [o, 1] of the world.
    """
    model = solver.model
    obs, u = jnp.zeros(spec.obs), jnp.zeros(spec.act)
    koopman = solver.solve(params, solver.init(jax.random.key(0), spec).policy)["gain"][0]

    def regression(x: Array, u: Array) -> Array:
        return model.step(params, model.lift(params, x), u)[: spec.obs]

    Q, R = weights(solver, spec)
    both = []
    for A, B in (map(jnp.asarray, linear), linearise(regression, obs, u)):
        P = riccati.finite_horizon(A, B, Q, R, solver.horizon)
        F = riccati.gain(A, B, P, R)[0]
        both.append(jnp.zeros_like(koopman).at[: spec.obs].set(F))
    return jnp.stack([koopman, *both])


def weights(solver: Any, spec: Any) -> tuple[Array, Array]:
    """Q [o, o] and R [m, m] of observations and actions."""
    Q = riccati.as_weights("state_weights", solver.state_weights, spec.obs)
    R = riccati.as_weights("action_weights", solver.action_weights, spec.act)
    return jnp.asarray(Q, jnp.float32), jnp.asarray(R, jnp.float32)


def roll(run: Run, F: Array, x: Array) -> tuple[Outcome, Array]:
    """The path [T+1, o] from x [o] with u = -F z, and its outcome."""
    world, solver, dt = run.agent.episode.env, run.agent.learners["policy"], run.agent.spec.dt
    params = solver.model.init(jax.random.key(0), run.agent.spec)
    Q, R = weights(solver, run.agent.spec)

    def decide(x: Array, _: None) -> tuple[Array, tuple[Array, ...]]:
        u = -F[None] @ solver.model.lift(params, x)
        applied = jnp.clip(u, -1, 1)
        after = world.dynamics(x, applied)
        paid = after @ Q @ after + applied @ R @ applied
        return after, (after, paid, jnp.any(u != applied))

    _, (path, paid, clipped) = jax.lax.scan(decide, x, None, length=STEPS)
    error = jnp.linalg.norm(path, axis=-1)
    outcome = Outcome(dt * paid.sum(), dt * error.sum(), clipped.mean())
    return outcome, jnp.concatenate([x[None], path])


def bound(run: Run, x0: Array) -> np.ndarray:
    """[N] cost of the optimal path from each start [N, o], by the exact model."""
    world, solver, spec = run.agent.episode.env, run.agent.learners["policy"], run.agent.spec
    Q, R = weights(solver, spec)

    def one(x: Array) -> Array:
        path = optimal(world.dynamics, Q, R, x, jnp.zeros((STEPS, spec.act)))
        return spec.dt * cost(path, Q, R)

    return np.asarray(jax.jit(jax.vmap(one))(x0))


def reported(outcome: Outcome, best: np.ndarray) -> dict[str, Any]:
    """Numbers of each horizon; outcomes [draws, horizons, regulators, starts], best [starts].

    Ratios are of means over starts, one for each draw.
    """
    numbers: dict[str, Any] = {}
    for i, horizon in enumerate(HORIZONS):
        one = jax.tree.map(lambda v, i=i: v[:, i], outcome)
        known = jax.tree.map(lambda v: v[:, 1], one)
        numbers[str(horizon)] = each = {
            "cost_of_known": known.cost.mean(),
            "error_of_known": known.error.mean(),
            "optimum": best.mean() / known.cost.mean(),
            "clipped": one.clipped.mean((0, 2)),  # of each regulator
        }
        for k, name in ((0, "Koopman"), (2, "regression")):
            each[name] = {
                "cost": one.cost[:, k].mean(1) / known.cost.mean(1),
                "error": one.error[:, k].mean(1) / known.error.mean(1),
                "less_cost": (one.cost[:, k] < known.cost).sum(1),
                "less_error": (one.error[:, k] < known.error).sum(1),
            }
    return numbers


def _starts(number: int, away: float) -> Array:
    """[N, 2] starts, |x_i| <= `away`."""
    return away * jax.random.uniform(jax.random.key(1_000), (number, 2), minval=-1.0)


def _spread(values: Sequence[float]) -> str:
    """Median and range of the draws."""
    return f"{np.median(values):.3f} ({np.min(values):.3f} to {np.max(values):.3f})"


def _picture(numbers: dict[str, Any], paths: Any, dt: float) -> Any:
    """Error over time, paths, and ratios of cost by horizon and by data."""
    figure = blank(9.5, 7.6)
    (over_time, plane), (by_horizon, by_data) = figure.subplots(2, 2)
    t = dt * np.arange(paths.shape[2])
    strokes = ("-", "-", "--")  # the third lies on the second
    for k, name in enumerate(REGULATORS):
        error = np.linalg.norm(paths[k], axis=-1)  # [starts, T+1]
        low, middle, high = np.quantile(error, [0.25, 0.5, 0.75], axis=0)
        over_time.semilogy(t, middle, strokes[k], color=OWN[k], label=name)
        over_time.fill_between(t, low, high, color=OWN[k], alpha=0.15, lw=0)
        for i in range(min(PATHS, len(error))):
            plane.plot(*paths[k, i].T, strokes[k], color=OWN[k], lw=1, label=name * (not i))
    over_time.set(xlabel="Time [s]", title=f"|x|, median and quartiles of starts, T = {SHOWN}")
    over_time.set(xlim=(0, 6), ylim=(3e-3, None))
    plane.set(xlabel="x1", ylabel="x2", title=f"Paths from {PATHS} starts, T = {SHOWN}")
    inside = numbers["by_data"][f"{INSIDE[0]:g}, starts {INSIDE[1]:g}"]
    _ratios(by_horizon, inside)
    by_horizon.set(xlabel="Horizon of the regulators [decisions]", title="Cost over known's")
    last = HORIZONS[-1]
    at = {data: horizons[str(last)] for data, horizons in numbers["by_data"].items()}
    _ratios(by_data, at)
    by_data.set(xlabel="Samples within", title=f"Cost over known's, T = {last}")
    plain_log(over_time.yaxis)
    for axes in (over_time, plane, by_horizon, by_data):
        legend_below(axes)
    return figure


def _ratios(axes: Any, columns: dict[str, Any]) -> None:
    """A point for each draw, and the optimum, in a column each."""
    for k, name in ((0, "Koopman"), (2, "regression")):
        points = [
            (i + 0.1 * (k - 1), ratio)
            for i, one in enumerate(columns.values())
            for ratio in one[name]["cost"]
        ]
        axes.plot(*np.array(points).T, "o", ms=4, color=OWN[k], label=name)
    optima = [one["optimum"] for one in columns.values()]
    axes.plot(range(len(optima)), optima, "_", ms=18, mew=1.5, color=GREY, label="optimum")
    axes.axhline(1, color=BLACK, lw=1, label="known")
    axes.set_xticks(range(len(columns)), list(columns))
