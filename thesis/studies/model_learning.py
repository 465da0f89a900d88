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

from time import perf_counter
from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.analysis.curves import plural
from hybrid_rl.analysis.results import find
from hybrid_rl.analysis.style import blank, legend_outside, line_styles, plain_log
from hybrid_rl.cli.arguments import whole
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.settings.build import Run, build, load
from hybrid_rl.thesis.studies.flights import Flight, cost, equal_size, read_all
from hybrid_rl.thesis.studies.numbers import banded, rounded
from hybrid_rl.thesis.studies.unseen import transitions
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
    folders = find(runs)
    flights, dt = equal_size(read_all(folders)), QuadcopterSE3().spec.dt
    results: Results = {flight.label: cost(flight) for flight in flights}
    if updates:
        tracked = measure(flights, updates, steps)
        results = {label: results.get(label, {}) | tracked[label] for label in [*results, EXACT]}
    numbers = {label: reported(each, dt) for label, each in results.items()}
    return draw(numbers) if updates else plot_flights(flights, dt), numbers


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
    x, distance = states.obs, jnp.linalg.norm(states.obs[:, :3], axis=-1)
    return Tracked(transitions(x[:-1], u, x[1:]), distance, states.terminated[-1])


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
        numbers[name] = [values[name].mean(), values[name].std()]
    if "lost" in values:
        numbers["kept_hover"] = 1 - values["lost"].mean()
    if "error" in values:
        numbers["error"] = banded(values["error"])
    if "distance" in values:
        distance = values["distance"]
        numbers["tracking"] = banded(distance.mean(1))
        for mark in MARKS:
            if round(mark / dt) < distance.shape[1]:
                numbers[f"distance_after_{mark:g}_s"] = banded(distance[:, round(mark / dt)])
        numbers["turned_over_tracking"] = values["turned_over"].mean()
    return rounded(numbers)


def named(label: str) -> str:
    """A label in words: "ou_noise 0.1" is "ou_noise, level 0.1"."""
    algo, *rest = label.split()
    return f"{algo}, {'level' if algo.endswith('noise') else 'gain'} {' '.join(rest)}"


def plot_flights(flights: list[Flight], dt: float) -> Any:
    """Actions and velocities of the first trial of each method."""
    figure = blank(9, 0.5 + 1.3 * len(flights))
    panels: Any = figure.subplots(len(flights), 3, squeeze=False, sharex=True, sharey="col")
    for row, flight in zip(panels, flights, strict=True):
        t, x = dt * np.arange(flight.obs.shape[1]), flight.obs[0]
        row[0].plot(t, np.linalg.norm(flight.action[0], axis=-1), lw=0.6, color="k")
        row[1].plot(t, x[:, V], lw=0.8)
        row[2].plot(t, x[:, W], lw=0.8)
        row[0].set_ylabel(named(flight.label).replace(", ", "\n"), fontsize=8)
    for axes, name in zip(panels[0], ("|u|", "v [m/s]", "w [rad/s]"), strict=True):
        axes.set_title(name)
    for axes in panels[-1]:
        axes.set_xlabel("Time [s]")
    return figure


def draw(numbers: dict[str, Any]) -> Any:
    """Distance to the target of each method's best setting; error and distance over power loss."""
    methods: dict[str, list[dict[str, Any]]] = {}
    for label, one in numbers.items():
        methods.setdefault(EXACT if label == EXACT else label.split()[0], []).append(one)
    styles = line_styles(methods)
    figure = blank(9, 3.6)
    over_time, errors, tracking = figure.subplots(1, 3)
    for name, each in methods.items():
        _over_time(over_time, min(each, key=lambda one: one["tracking"][0]), styles[name], name)
        if name != EXACT:
            _over_power(errors, each, "error", styles[name])
            _over_power(tracking, each, "tracking", styles[name])
    tracking.axhline(numbers[EXACT]["tracking"][0], **styles[EXACT] | {"marker": None}, lw=0.8)
    over_time.set(xlabel="Time [s]", yscale="log")
    over_time.set_title("Distance to the target [m],\nbest level")
    errors.set_title("Error of one decision")
    tracking.set_title("Mean distance\nto the target [m]")
    for axes in (errors, tracking):
        axes.set(xlabel="Power loss of the flight [N]", xscale="log", yscale="log")
        axes.margins(0.12)
        plain_log(axes.xaxis, narrow=True)
    for axes in (over_time, errors, tracking):
        plain_log(axes.yaxis)
    legend_outside(over_time)
    return figure


def _over_time(axes: Any, one: dict[str, Any], style: dict[str, Any], label: str) -> None:
    """IQM and band of the distance to the target after MARKS of one method."""
    times = [mark for mark in MARKS if f"distance_after_{mark:g}_s" in one]
    if times:
        each = np.array([one[f"distance_after_{mark:g}_s"] for mark in times])
        axes.fill_between(times, each[:, 1], each[:, 2], color=style["color"], alpha=0.12, lw=0)
    axes.plot(times, [one[f"distance_after_{t:g}_s"][0] for t in times], label=label, ms=4, **style)


def _over_power(axes: Any, each: list[dict[str, Any]], name: str, style: dict[str, Any]) -> None:
    """IQM and band of a quantity per setting of a method, over the power loss of its flights."""
    points = sorted((one["power_loss"][0], *one[name]) for one in each)
    power, middle, low, high = np.array(points).T
    axes.errorbar(power, middle, (middle - low, high - middle), ms=4, **style)
