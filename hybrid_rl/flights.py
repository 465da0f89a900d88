"""What flights cost, and how well models learned from them fly (table 6.1, figures 6-6 and 6-7).

    python -m hybrid_rl.flights runs="runs/quadcopter_se3/*/*" out=table_6_1.png

From the decisions that each run remembers a model is learned anew, the same way for all methods,
updates=2000 batches a trial. It is asked for the next state on flights of other trials, by all
methods, and MPPI flies to a target by it for steps=1200 decisions. updates=0 or steps=0 leave that
out. All flights are cut to the shortest. The numbers are written beside the picture, as JSON.

    power loss   mean |F - m g| [N], F the thrust of all rotors
    norm of u    mean |u|, u in [-1, 1]^4; at hover 0.82
    error        root mean square error of v and w after one decision, by their change's deviation
"""

import glob
import json
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from omegaconf import OmegaConf

from hybrid_rl import command
from hybrid_rl.config import Run, UsageError, build, load
from hybrid_rl.envs.quadcopter_se3 import KT, MASS, THRUST, G, QuadcopterSE3
from hybrid_rl.training import checkpoint
from hybrid_rl.training.evaluate import rollout
from hybrid_rl.training.loop import Loop
from hybrid_rl.types import Batch, Params

DEFAULTS = {"runs": "", "out": "flights.png", "updates": "2000", "steps": "1200"}
TRACKING = ("experiment=thesis/fig_6_6",)
SUFFIXES = (".png", ".pdf", ".svg")
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
    noise = config.controllers.full.get("kind")
    label = f"{config.algo} {config.controllers.full.level:g}" if noise else str(config.algo)
    flown = int(np.asarray(memory.count).min())
    return first(label, memory, min(flown, memory.rows.shape[1]))


def first(label: str, memory: Any, length: int) -> Flight:
    """The first `length` decisions that `memory` [S, ...] holds."""
    count = jnp.minimum(memory.count, length)
    memory = memory.replace(rows=memory.rows[:, :length], count=count)
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
    first, rest = jax.random.split(key)

    def one(state: Any, key: Array) -> tuple[Any, None]:
        batch = replay.sample(memory, run.agent.spec, learner.batch_size, key)
        return learner.update(state, Params(), batch, key)[0], None

    state = learner.init(first, run.agent.spec)
    state = jax.lax.scan(one, state, jax.random.split(rest, updates))[0]
    return Params(**learner.params(state))


def error(run: Run, params: Params, seen: Batch) -> Array:
    """Of one step of the model, on decisions `seen` [B] (see above)."""
    model: Any = run.agent.learners["model"]
    ahead = jax.vmap(model.model.step, (None, 0, 0))(params.model, seen.obs, seen.action)
    apart = (ahead - seen.next_obs)[:, TWIST]
    change = (seen.next_obs - seen.obs)[:, TWIST]
    return jnp.sqrt(jnp.mean(jnp.mean(apart**2, 0) / jnp.var(change, 0)))


def track(run: Run, params: Params, steps: int, key: Array) -> tuple[Array, Array]:
    """Distance to the target [steps+1] [m], and whether it turned over []. The key is consumed."""
    states = rollout(run.agent.episode, run.controllers["full"], params, key, steps)
    return jnp.linalg.norm(states.obs[:, :3], axis=-1), states.terminated[-1]


def others(flights: list[Flight], trial: int, count: int = 2000) -> Batch:
    """Decisions [count] of the trial after `trial`, by all methods, drawn alike."""
    trials = len(flights[0].obs)
    parts = [
        np.concatenate([getattr(f, name)[(trial + 1) % trials] for f in flights])
        for name in ("obs", "action", "next_obs")
    ]
    draw = np.random.default_rng(trial).integers(len(parts[0]), size=count)
    x, u, after = (part[draw] for part in parts)
    no = np.zeros(count)
    return Batch(x, u, no, no, no, after, u)  # type: ignore[arg-type]


def measure(
    flights: list[Flight], updates: int, steps: int
) -> tuple[dict[str, dict[str, Any]], float]:
    """Per method and trial all that is told of it, and [s] of a decision."""
    run = build(load([*TRACKING, f"episode.steps={steps + 1}"]))
    trials = len(flights[0].obs)
    seen = jax.tree.map(lambda *x: jnp.stack(x), *[others(flights, i) for i in range(trials)])
    keys = jax.vmap(lambda i: jax.random.split(jax.random.key(i)))(jnp.arange(trials))

    @jax.jit
    def all_of(memory: Any) -> tuple:
        if not updates:
            return ()
        params = jax.vmap(lambda m, k: learn(run, m, updates, k))(memory, keys[:, 0])
        wrong = jax.vmap(lambda p, s: error(run, p, s))(params, seen)
        flown = jax.vmap(lambda p, k: track(run, p, steps, k))(params, keys[:, 1]) if steps else ()
        return wrong, *flown

    found = {}
    for flight in flights:
        names = ("error", "distance", "turned_over")
        learned = zip(names, map(np.asarray, all_of(flight.memory)), strict=False)
        flown = {"decisions": flight.obs.shape[1]}
        found[flight.label] = {**flown, **cost(flight), **dict(learned)}
    return found, run.agent.spec.dt


def said(found: dict[str, np.ndarray], dt: float) -> dict[str, Any]:
    """What the JSON holds of one method."""
    numbers: dict[str, Any] = {"trials": len(found["lost"]), "decisions": found["decisions"]}
    for name in [n for n in ("power_loss", "norm_of_u", "furthest", "error") if n in found]:
        numbers[name] = [_short(found[name].mean()), _short(found[name].std())]
    numbers["kept_hover"] = _short(1 - found["lost"].mean())
    if "distance" not in found:
        return numbers
    numbers["turned_over_tracking"] = _short(found["turned_over"].mean())
    for at in MARKS:
        if round(at / dt) < found["distance"].shape[1]:
            after = np.quantile(found["distance"][:, round(at / dt)], [0.5, 0, 1])
            numbers[f"distance_after_{at:g}_s"] = [_short(each) for each in after]
    return numbers


def plot(flights: list[Flight], found: dict[str, Any], dt: float) -> Any:
    """Tracking error of all, and the first trial of each."""
    import matplotlib
    from matplotlib.figure import Figure

    from hybrid_rl.figures import COLOURS, STYLE

    tracked = "distance" in found[flights[0].label]
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(2.2 * max(3, len(flights)), 4 + 3 * tracked), layout="constrained")
        parts: Any = figure.subfigures(1 + tracked, 1, squeeze=False)[:, 0]
        if tracked:
            axes = parts[-1].subplots()
            for flight, colour in zip(flights, COLOURS, strict=False):
                each = found[flight.label]["distance"]
                low, middle, high = np.quantile(each, [0.25, 0.5, 0.75], axis=0)
                t = dt * np.arange(each.shape[1])
                axes.plot(t, middle, color=colour, label=flight.label)
                axes.fill_between(t, low, high, color=colour, alpha=0.12, lw=0)
            axes.set(xlabel="Time [s]", ylabel="Distance to the target [m]", yscale="log")
            axes.set_title("MPPI on the learned model: median and quartiles over trials")
            axes.legend(ncols=2)
        panels = parts[0].subplots(3, len(flights), squeeze=False, sharex=True, sharey="row")
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


def _short(value: Any) -> float:
    return float(f"{value:.4g}")


def main() -> None:
    """The command."""
    given = DEFAULTS | command.arguments(DEFAULTS)
    folders = sorted(Path(place) for place in glob.glob(given["runs"]))
    if not folders:
        raise UsageError(f"runs={given['runs']}: no run folder there; say runs=GLOB")
    out = Path(given["out"])
    if out.suffix not in SUFFIXES:
        raise UsageError(f"out={out}: must end in {', '.join(SUFFIXES)}")
    numbers = (
        command.count("updates", given["updates"], least=0),
        command.count("steps", given["steps"], least=0),
    )
    flights = sorted((read(folder) for folder in folders), key=lambda flight: flight.label)
    if len({len(flight.obs) for flight in flights}) > 1:
        raise UsageError(f"runs={given['runs']}: trials differ in number")
    shortest = min(flight.obs.shape[1] for flight in flights)
    flights = [first(flight.label, flight.memory, shortest) for flight in flights]
    found, dt = measure(flights, *numbers)
    told = {label: said(each, dt) for label, each in found.items()}
    out.parent.mkdir(parents=True, exist_ok=True)
    plot(flights, found, dt).savefig(out, dpi=130)
    out.with_suffix(".json").write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
    print(f"{out} and {out.with_suffix('.json')}")


if __name__ == "__main__":
    command.guarded(main)
