"""Model learning in flight: cost of flights, and MPPI by the models learned from them.

    python -m hybrid_rl.figures study=model_learning runs="runs/quadcopter_se3/*/*" out=fig_6_6.png

Figures 6-6 and 6-7; with updates=0, which learns nothing and plots the flights themselves, table
6.1. A model is learned from the decisions in the replay memory of each run, in the same way for all
methods. MPPI then flies to a target with it, each trial to its own, the same for all methods; and
with the exact model, which shows what the planner alone can do. All methods are cut to the shortest
flight and to the fewest trials.

    power loss   mean |F - m g| [N], F the thrust of all rotors
    norm of u    mean |u|, u in [-1, 1]^4; at hover 0.82
    error        root mean square error of v and w after one decision, divided by the standard
                 deviation of their change, along the flights with the exact model, which are in
                 no training data
    tracking     mean distance to the target over the flight [m]
"""

import glob
from pathlib import Path
from time import perf_counter
from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.cli.arguments import whole
from hybrid_rl.config import Run, build, load
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.errors import UsageError
from hybrid_rl.studies.curves import band, iqm, plural
from hybrid_rl.studies.flights import Flight, cost, equal_size, read_all
from hybrid_rl.studies.style import COLOURS, ENTRY, STROKES, STYLE, legend_below, plain_log
from hybrid_rl.training.rollout import rollout_with_actions
from hybrid_rl.types import Batch, Params

TRACKING = ("experiment=thesis/fig_6_6",)
KNOWN = ("+model@known_model=exact", "model_planner.model=${known_model}")
EXACT = "exact model"
V, W = slice(12, 15), slice(15, 18)  # v [m/s] and w [rad/s] in an observation
TWIST = slice(V.start, W.stop)
MARKS = (1.0, 2.0, 4.0, 6.0)  # [s] at which distances are reported
TRACKED = ("distance", "turned_over")  # fields that are reported
Results = dict[str, dict[str, np.ndarray]]  # label -> quantity -> [S, ...]


def figure(
    runs: Annotated[str, 'run folders, as "runs/quadcopter_se3/*/*" in quotes'],
    updates: Annotated[int, "batches from which each model learns; 0: none", whole(0)] = 2000,
    steps: Annotated[int, "decisions of each flight to a target", whole()] = 1200,
) -> tuple[Any, dict[str, Any]]:
    """Tracking over time and power loss, or the flights themselves if `updates` is 0."""
    folders = sorted(Path(path) for path in glob.glob(runs))
    if not folders:
        raise UsageError(f"runs={runs}: no run folder matches")
    flights, dt = equal_size(read_all(folders)), QuadcopterSE3().spec.dt
    results: Results = {flight.label: cost(flight) for flight in flights}
    if updates:
        tracked = measure(flights, updates, steps)
        results = {label: results.get(label, {}) | tracked[label] for label in [*results, EXACT]}
    numbers = {label: reported(each, dt) for label, each in results.items()}
    return plot_tracking(results, dt) if updates else plot_flights(flights, dt), numbers


def summary(numbers: dict[str, Any]) -> list[str]:
    """A line per method: costs as mean ± deviation, error and tracking as IQM [band]."""
    lines = []
    for label, one in numbers.items():
        parts = []
        if "power_loss" in one:
            (loss, loss_deviation), (norm, norm_deviation) = one["power_loss"], one["norm_of_u"]
            parts.append(f"power loss {loss:g} ± {loss_deviation:g} N")
            parts.append(f"|u| {norm:g} ± {norm_deviation:g}")
            parts.append(f"kept the hover in {one['kept_hover']:.0%}")
        for name, unit in (("error", ""), ("tracking", " m")):
            if name in one:
                middle, low, high = one[name]
                parts.append(f"{name} {middle:g} [{low:g}, {high:g}]{unit}")
        lines.append(f"{label}, {plural(one['trials'], 'trial')}: {', '.join(parts)}")
    return lines


def learn(run: Run, memory: Any, updates: int, key: Array) -> Params:
    """A model learned from the decisions in one trial's memory. The key is consumed."""
    learner, replay = run.agent.learners["model"], run.agent.replay
    first, drawing, updating = jax.random.split(key, 3)
    rows = learner.batches * learner.batch_size

    def one(state: Any, keys: tuple[Array, Array]) -> tuple[Any, None]:
        batch = replay.sample(memory, run.agent.spec, rows, keys[0])
        return learner.update(state, Params(), batch, keys[1])[0], None

    state = learner.init(first, run.agent.spec)
    each = jax.random.split(drawing, updates), jax.random.split(updating, updates)
    state = jax.lax.scan(one, state, each)[0]
    return Params(**learner.params(state))


def error(run: Run, params: Params, data: Batch) -> Array:
    """Normalised one-step error [] of the model on the decisions `data` [B] (see the module)."""
    model: Any = run.agent.learners["model"]
    predicted = jax.vmap(model.model.step, (None, 0, 0))(params.model, data.obs, data.action)
    difference = (predicted - data.next_obs)[:, TWIST]
    change = (data.next_obs - data.obs)[:, TWIST]
    return jnp.sqrt(jnp.mean(jnp.mean(difference**2, 0) / jnp.var(change, 0)))


class Tracked(NamedTuple):
    """A flight to a target."""

    data: Batch  # [B] its decisions
    distance: Array  # [B+1] to the target [m]
    turned_over: Array  # []


def track(run: Run, params: Params, steps: int, key: Array) -> Tracked:
    """MPPI with the model in `params`, for B = `steps` decisions. The key is consumed."""
    u, states = rollout_with_actions(run.agent.episode, run.controllers["full"], params, key, steps)
    no, x = jnp.zeros(steps), states.obs
    distance = jnp.linalg.norm(x[:, :3], axis=-1)
    return Tracked(Batch(x[:-1], u, no, no, no, x[1:]), distance, states.terminated[-1])


def measure(flights: list[Flight], updates: int, steps: int) -> Results:
    """Error and tracking of each method's models, and tracking of the exact model.

    Prints a line as each method is done.
    """
    began = perf_counter()
    print(f"compiling; then {len(flights)} methods, each {updates:,} updates a trial", flush=True)
    run = build(load([*TRACKING, f"episode.steps={steps + 1}"]))
    known = build(load([*TRACKING, *KNOWN, f"episode.steps={steps + 1}"]))
    trials = len(flights[0].obs)
    keys = jax.vmap(lambda i: jax.random.split(jax.random.key(i)))(jnp.arange(trials))
    exact = jax.jit(jax.vmap(lambda k: track(known, Params(), steps, k)))(keys[:, 1])

    def one(args: tuple[Any, Batch, Array]) -> dict[str, Array]:
        memory, data, (learning, flying) = args
        params = learn(run, memory, updates, learning)
        tracked = track(run, params, steps, flying)._asdict()
        return {"error": error(run, params, data)} | {name: tracked[name] for name in TRACKED}

    results: Results = {EXACT: {name: np.asarray(getattr(exact, name)) for name in TRACKED}}
    all_trials = jax.jit(lambda *args: jax.lax.map(one, args))  # on two cores faster than `vmap`
    for number, flight in enumerate(flights, 1):
        learned = all_trials(flight.memory, exact.data, keys)
        results[flight.label] = {name: np.asarray(value) for name, value in learned.items()}
        progress = f"{number} of {len(flights)}, {perf_counter() - began:.0f} s"
        print(f"{flight.label}: learned and flown ({progress})", flush=True)
    return results


def reported(values: dict[str, np.ndarray], dt: float) -> dict[str, Any]:
    """The numbers of one method: mean and deviation of costs; IQM and band of the rest."""
    numbers: dict[str, Any] = {"trials": len(next(iter(values.values())))}
    for name in [n for n in ("power_loss", "norm_of_u", "furthest") if n in values]:
        numbers[name] = [_rounded(values[name].mean()), _rounded(values[name].std())]
    if "lost" in values:
        numbers["kept_hover"] = _rounded(1 - values["lost"].mean())
    if "error" in values:
        numbers["error"] = _banded(values["error"])
    if "distance" in values:
        distance = values["distance"]
        numbers["tracking"] = _banded(distance.mean(1))
        for mark in MARKS:
            if round(mark / dt) < distance.shape[1]:
                numbers[f"distance_after_{mark:g}_s"] = _banded(distance[:, round(mark / dt)])
        numbers["turned_over_tracking"] = _rounded(values["turned_over"].mean())
    return numbers


def _banded(each: np.ndarray) -> list[float]:
    """IQM over trials [S], and its band."""
    return [_rounded(iqm(each)), *map(_rounded, band(each))]


def _rounded(value: Any) -> float:
    """Four significant digits."""
    return float(f"{value:.4g}")


def named(label: str, trials: int = 0) -> str:
    """A label for a legend: "ou_noise 0.1" is "ou_noise, level 0.1", with the number of trials."""
    algo, *rest = label.split()
    words = algo if label != EXACT else label
    if label != EXACT:
        words += f", {'level' if algo.endswith('noise') else 'gain'} {' '.join(rest)}"
    return f"{words} ({plural(trials, 'trial')})" if trials else words


def plot_flights(flights: list[Flight], dt: float) -> Any:
    """Actions and velocities of the first trial of each method."""
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(2.2 * max(3, len(flights)), 4), layout="constrained")
        panels: Any = figure.subplots(3, len(flights), squeeze=False, sharex=True, sharey="row")
        for column, flight in zip(panels.T, flights, strict=True):
            t, x = dt * np.arange(flight.obs.shape[1]), flight.obs[0]
            column[0].plot(t, np.linalg.norm(flight.action[0], axis=-1), lw=0.6, color="k")
            column[1].plot(t, x[:, V], lw=0.8)
            column[2].plot(t, x[:, W], lw=0.8)
            column[0].set_title(named(flight.label).replace(", ", "\n"), fontsize=8)
            column[2].set_xlabel("Time [s]")
        for axes, name in zip(panels[:, 0], ("|u|", "v [m/s]", "w [rad/s]"), strict=True):
            axes.set_ylabel(name)
    return figure


def plot_tracking(results: Results, dt: float) -> Any:
    """Tracking over time; the models' error and tracking over the power loss of their flights."""
    import matplotlib
    from matplotlib.figure import Figure

    methods = sorted({label.split()[0] for label in results if label != EXACT})
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(13, 4.2 + ENTRY * len(results)), layout="constrained")
        over_time, errors, tracking = figure.subplots(1, 3)
        _over_time(over_time, EXACT, results[EXACT]["distance"], ("k", "-"), dt)
        for name, colour in zip(methods, COLOURS, strict=False):
            labels = [la for la in results if la.split()[0] == name and la != EXACT]
            for i, label in enumerate(labels):
                style = colour, STROKES[i % len(STROKES)]
                _over_time(over_time, label, results[label]["distance"], style, dt)
            each = [results[label] for label in labels]
            _over_power(errors, name, [(one, one["error"]) for one in each], colour)
            _over_power(tracking, name, [(one, one["distance"].mean(1)) for one in each], colour)
        exact = iqm(results[EXACT]["distance"].mean(1))
        tracking.axhline(exact, color="k", lw=0.8, label=EXACT)
        over_time.set(
            xlim=(0, None), xlabel="Time [s]", title="Distance to the target [m]", yscale="log"
        )
        errors.set(title="Error of one decision")
        tracking.set(title="Mean distance to the target [m]")
        for axes in (errors, tracking):
            axes.set(xlabel="Power loss of the flight [N]", xscale="log", yscale="log")
            axes.margins(0.12)
            plain_log(axes.xaxis)
        for axes in (over_time, errors, tracking):
            plain_log(axes.yaxis)
            legend_below(axes)
    return figure


def _over_time(axes: Any, label: str, distance: np.ndarray, style: Any, dt: float) -> None:
    """IQM and band of the distances to the target [S, B+1] of one method."""
    each, (colour, stroke) = distance[:, ::10], style
    t, (low, high) = 10 * dt * np.arange(each.shape[1]), band(each, 500)
    marker = "o" if len(t) == 1 else None
    shown = named(label, len(each))
    axes.plot(t, iqm(each), color=colour, linestyle=stroke, marker=marker, label=shown)
    axes.fill_between(t, low, high, color=colour, alpha=0.12, lw=0)


def _over_power(axes: Any, name: str, pairs: list[tuple[dict, np.ndarray]], colour: str) -> None:
    """IQM and band of values [S] per setting of a method, over the power loss of its flights."""
    points = [(one["power_loss"].mean(), values) for one, values in pairs]
    points.sort(key=lambda point: point[0])
    middle = np.array([iqm(values) for _, values in points])
    ends = np.abs(np.array([band(values) for _, values in points]).T - middle[None])
    power = [at for at, _ in points]
    axes.errorbar(power, middle, ends, color=colour, marker="o", ms=4, label=name)
