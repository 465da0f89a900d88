"""What flights cost, and how well models learned from them fly (table 6.1, figures 6-6 and 6-7).

    python -m hybrid_rl.flights runs="runs/quadcopter_se3/*/*" out=fig_6_6.png

From the decisions that each run remembers a model is learned anew, the same way for all methods,
updates=2000 batches a trial. MPPI flies to a target by it for steps=1200 decisions, each trial to
its own, the same for all methods; and by the exact model, which shows what the planner alone can
do. updates=0 learns nothing, and draws the flights themselves. All methods are cut to the shortest
flight and to the fewest trials. The numbers are written beside the picture, as JSON.

    power loss   mean |F - m g| [N], F the thrust of all rotors
    norm of u    mean |u|, u in [-1, 1]^4; at hover 0.82
    error        root mean square error of v and w after one decision, by their change's deviation,
                 along the flights that the exact model made: nobody learned from those
    tracking     mean distance to the target over the flight [m]
"""

if __name__ == "__main__":
    from hybrid_rl import interrupt

    interrupt.install()

import glob
import json
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from omegaconf import OmegaConf

from hybrid_rl import arguments, command
from hybrid_rl.arguments import Argument, output, whole
from hybrid_rl.config import Run, UsageError, build, load
from hybrid_rl.curves import band, iqm
from hybrid_rl.envs.quadcopter_se3 import KT, MASS, THRUST, G, QuadcopterSE3
from hybrid_rl.training import checkpoint
from hybrid_rl.training.evaluate import acted
from hybrid_rl.training.loop import Loop
from hybrid_rl.types import Batch, Params

TRACKING = ("experiment=thesis/fig_6_6",)
KNOWN = ("model@known_model=exact", "model_planner.model=${known_model}")
EXACT = "exact model"
SUFFIXES = (".png", ".pdf", ".svg")
RUNS = 'runs="GLOB", such as runs="runs/quadcopter_se3/*/*"'
ARGUMENTS = (
    Argument("runs", "", "pattern of the run folders, in quotes", needed=RUNS),
    Argument("out", "flights.png", f"the picture: {', '.join(SUFFIXES)}; numbers beside it"),
    Argument("updates", 2000, "batches of which each model learns; 0: none", whole(least=0)),
    Argument("steps", 1200, "decisions of each flight to a target", whole()),
)
TWIST = slice(12, 18)  # v [m/s] and w [rad/s] in an observation
MARKS = (1.0, 2.0, 4.0, 6.0)  # [s] at which distances are told


class Flight(NamedTuple):
    """All trials of one method."""

    label: str
    memory: Any  # [S, T, ...]
    obs: np.ndarray  # [S, T, 18]
    action: np.ndarray  # [S, T, 4]
    next_obs: np.ndarray  # [S, T, 18]
    terminated: np.ndarray  # [S, T]


def read(folder: Path) -> Flight:
    """What the run in `folder` remembers.

    Raises:
        UsageError: where it is no whole flight of one world.
    """
    config: Any = OmegaConf.load(folder / "config.yaml")
    if config.task != "quadcopter_se3" or config.num_envs != 1 or not config.checkpoint_replay:
        raise UsageError(f"runs={folder}: needs quadcopter_se3, num_envs=1, checkpoint_replay=true")
    run = build(config)
    like = jax.eval_shape(Loop(run.agent, run.seeds, 1).init)
    like = like.replace(env=None, control=None, learners=None, key=None)
    memory = checkpoint.restore(folder / "checkpoints", like, part=True)[1].memory
    explorer = config.controllers.full
    strength = explorer.level if "kind" in explorer else explorer.gain
    label = f"{config.algo} {strength:g}"
    flown = int(np.asarray(memory.count).min())
    return first(label, memory, len(memory.rows), min(flown, memory.rows.shape[1]))


def first(label: str, memory: Any, trials: int, length: int) -> Flight:
    """The first `length` decisions of the first `trials` that `memory` [S, ...] holds."""
    count = jnp.minimum(memory.count[:trials], length)
    memory = memory.replace(rows=memory.rows[:trials, :length], count=count)
    rows, (o, m) = np.asarray(memory.rows)[:, :, 0], QuadcopterSE3().spec[:2]
    parts = np.split(rows, [o, o + m, o + m + 1, o + m + 2, o + m + 3], axis=-1)
    return Flight(label, memory, parts[0], parts[1], parts[5], parts[3][..., 0])


def cost(flight: Flight) -> dict[str, np.ndarray]:
    """Per trial [S]: power loss [N], norm of u, furthest from the hover [m], whether lost."""
    thrust = KT * THRUST * flight.action.sum(-1)
    return {
        "power_loss": np.abs(thrust - MASS * G).mean(1),
        "norm_of_u": np.linalg.norm(flight.action, axis=-1).mean(1),
        "furthest": np.linalg.norm(flight.next_obs[..., :3], axis=-1).max(1),
        "lost": flight.terminated.max(1),
    }


def learn(run: Run, memory: Any, updates: int, key: Array) -> Params:
    """A model of the decisions in one trial's memory. The key is consumed."""
    learner, replay = run.agent.learners["model"], run.agent.replay
    first, drawing, updating = jax.random.split(key, 3)

    def one(state: Any, keys: tuple[Array, Array]) -> tuple[Any, None]:
        batch = replay.sample(memory, run.agent.spec, learner.batch_size, keys[0])
        return learner.update(state, Params(), batch, keys[1])[0], None

    state = learner.init(first, run.agent.spec)
    each = jax.random.split(drawing, updates), jax.random.split(updating, updates)
    state = jax.lax.scan(one, state, each)[0]
    return Params(**learner.params(state))


def error(run: Run, params: Params, seen: Batch) -> Array:
    """Of one step of the model, on decisions `seen` [B] (see above)."""
    model: Any = run.agent.learners["model"]
    ahead = jax.vmap(model.model.step, (None, 0, 0))(params.model, seen.obs, seen.action)
    apart = (ahead - seen.next_obs)[:, TWIST]
    change = (seen.next_obs - seen.obs)[:, TWIST]
    return jnp.sqrt(jnp.mean(jnp.mean(apart**2, 0) / jnp.var(change, 0)))


class Tracked(NamedTuple):
    """A flight to a target."""

    seen: Batch  # [B] its decisions
    distance: Array  # [B+1] to the target [m]
    turned_over: Array  # []


def track(run: Run, params: Params, steps: int, key: Array) -> Tracked:
    """MPPI by the model in `params`, for B = `steps` decisions. The key is consumed."""
    u, states = acted(run.agent.episode, run.controllers["full"], params, key, steps)
    no, x = jnp.zeros(steps), states.obs
    distance = jnp.linalg.norm(x[:, :3], axis=-1)
    return Tracked(Batch(x[:-1], u, no, no, no, x[1:], u), distance, states.terminated[-1])


def measure(flights: list[Flight], updates: int, steps: int) -> dict[str, dict[str, Any]]:
    """Per method and trial all that is told of it."""
    found = {flight.label: cost(flight) for flight in flights}
    if not updates:
        return found
    run = build(load([*TRACKING, f"episode.steps={steps + 1}"]))
    known = build(load([*TRACKING, *KNOWN, f"episode.steps={steps + 1}"]))
    trials = len(flights[0].obs)
    keys = jax.vmap(lambda i: jax.random.split(jax.random.key(i)))(jnp.arange(trials))
    exact = jax.jit(jax.vmap(lambda k: track(known, Params(), steps, k)))(keys[:, 1])

    def one(given: tuple[Any, Batch, Array]) -> tuple[Array, Array, Array]:
        memory, seen, (learning, flying) = given
        params = learn(run, memory, updates, learning)
        flown = track(run, params, steps, flying)
        return error(run, params, seen), flown.distance, flown.turned_over

    all_of = jax.jit(lambda *given: jax.lax.map(one, given))  # on two cores faster than `vmap`
    for flight in flights:
        names = ("error", "distance", "turned_over")
        learned = map(np.asarray, all_of(flight.memory, exact.seen, keys))
        found[flight.label] |= dict(zip(names, learned, strict=True))
    found[EXACT] = {
        "distance": np.asarray(exact.distance),
        "turned_over": np.asarray(exact.turned_over),
    }
    return found


def said(found: dict[str, np.ndarray], dt: float) -> dict[str, Any]:
    """What the JSON holds of one method.

    Of what a flight cost mean and deviation over trials; of what its model can do IQM and band.
    """
    numbers: dict[str, Any] = {"trials": len(next(iter(found.values())))}
    for name in [n for n in ("power_loss", "norm_of_u", "furthest") if n in found]:
        numbers[name] = [_short(found[name].mean()), _short(found[name].std())]
    if "lost" in found:
        numbers["kept_hover"] = _short(1 - found["lost"].mean())
    if "error" in found:
        numbers["error"] = _banded(found["error"])
    if "distance" in found:
        distance = found["distance"]
        numbers["tracking"] = _banded(distance.mean(1))
        marks = [at for at in MARKS if round(at / dt) < distance.shape[1]]
        numbers |= {
            f"distance_after_{at:g}_s": _banded(distance[:, round(at / dt)]) for at in marks
        }
        numbers["turned_over_tracking"] = _short(found["turned_over"].mean())
    return numbers


def signals(flights: list[Flight], dt: float) -> Any:
    """Actions and velocities of the first trial of each method."""
    import matplotlib
    from matplotlib.figure import Figure

    from hybrid_rl.plotting import STYLE

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(2.2 * max(3, len(flights)), 4), layout="constrained")
        panels: Any = figure.subplots(3, len(flights), squeeze=False, sharex=True, sharey="row")
        for i, flight in enumerate(flights):
            t, x = dt * np.arange(flight.obs.shape[1]), flight.obs[0]
            panels[0][i].plot(t, np.linalg.norm(flight.action[0], axis=-1), lw=0.6, color="k")
            panels[1][i].plot(t, x[:, 12:15], lw=0.8)
            panels[2][i].plot(t, x[:, 15:18], lw=0.8)
            panels[0][i].set_title(flight.label, fontsize=8)
            panels[2][i].set_xlabel("Time [s]")
        for row, name in zip(panels, ("|u|", "v [m/s]", "w [rad/s]"), strict=True):
            row[0].set_ylabel(name)
    return figure


def outcome(found: dict[str, Any], dt: float) -> Any:
    """How models track over time; and their error and tracking over what their flights cost."""
    import matplotlib
    from matplotlib.figure import Figure

    from hybrid_rl.plotting import COLOURS, STROKES, STYLE

    methods = sorted({label.split()[0] for label in found if label != EXACT})
    of = {name: [la for la in found if la.split()[0] == name and la != EXACT] for name in methods}
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(13, 4.2), layout="constrained")
        over_time, wrong, tracks = figure.subplots(1, 3)
        lines = [(EXACT, "k", "-")] + [
            (label, colour, STROKES[i % len(STROKES)])
            for name, colour in zip(methods, COLOURS, strict=False)
            for i, label in enumerate(of[name])
        ]
        for label, colour, stroke in lines:
            each = found[label]["distance"][:, ::10]
            low, high = band(each, 500)
            t = 10 * dt * np.arange(each.shape[1])
            over_time.plot(t, iqm(each), color=colour, linestyle=stroke, label=label)
            over_time.fill_between(t, low, high, color=colour, alpha=0.12, lw=0)
        for name, colour in zip(methods, COLOURS, strict=False):
            at = sorted(of[name], key=lambda label: found[label]["power_loss"].mean())
            power = [found[label]["power_loss"].mean() for label in at]
            for axes, what in (
                (wrong, [found[label]["error"] for label in at]),
                (tracks, [found[label]["distance"].mean(1) for label in at]),
            ):
                middle = np.array([iqm(each) for each in what])
                ends = np.abs(np.array([band(each) for each in what]).T - middle[None])
                axes.errorbar(power, middle, ends, color=colour, marker="o", ms=4)
        tracks.axhline(iqm(found[EXACT]["distance"].mean(1)), color="k", lw=0.8)
        over_time.set(xlabel="Time [s]", title="Distance to the target [m]", yscale="log")
        wrong.set(xlabel="Power loss of the flight [N]", title="Error of one decision")
        tracks.set(xlabel="Power loss of the flight [N]", title="Mean distance [m]")
        for axes in (wrong, tracks):
            axes.set(xscale="log", yscale="log")
        over_time.legend(fontsize=6, ncols=2)  # the colours are those of all panels
    return figure


def _banded(each: np.ndarray) -> list[float]:
    """IQM over trials [S], and its band."""
    return [_short(iqm(each)), *map(_short, band(each))]


def _short(value: Any) -> float:
    return float(f"{value:.4g}")


def main() -> None:
    """The command."""
    given, _ = arguments.read(__doc__, ARGUMENTS)
    folders = sorted(Path(place) for place in glob.glob(given["runs"]))
    if not folders:
        raise UsageError(f"runs={given['runs']}: no run folder there; say {RUNS}")
    out = output("out", given["out"], SUFFIXES, ".json")
    command.prepare(load(TRACKING))
    numbers = given["updates"], given["steps"]
    flights = sorted((read(folder) for folder in folders), key=lambda flight: flight.label)
    least = [min(flight.obs.shape[axis] for flight in flights) for axis in (0, 1)]
    flights = [first(flight.label, flight.memory, *least) for flight in flights]
    found, dt = measure(flights, *numbers), QuadcopterSE3().spec.dt
    told = {label: said(each, dt) for label, each in found.items()}
    figure = outcome(found, dt) if EXACT in found else signals(flights, dt)
    out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(out, dpi=130)
    out.with_suffix(".json").write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
    print(f"{out} and {out.with_suffix('.json')}")


if __name__ == "__main__":
    command.guarded(main)
