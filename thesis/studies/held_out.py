"""Errors of learned models on decisions that none of them learned from.

    python -m hybrid_rl.figures study=held_out runs="runs/halfcheetah/*/*" out=held_out.png

    error = sqrt(mean_i mean_t (x'_i - f_i(x, u))^2 / var(x'_i - x_i))

1 is the error of a model that predicts the mean change. The decisions are new episodes of each
seed: with actions of the learned policies (of the runs with the most decisions, in equal parts),
and with uniformly random actions. IQM and 95% band over the seeds of each run.
"""

from typing import Annotated, Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.analysis.curves import band, iqm
from hybrid_rl.analysis.results import find
from hybrid_rl.analysis.style import blank, words
from hybrid_rl.cli.arguments import whole
from hybrid_rl.errors import UsageError
from hybrid_rl.run.saved import Trained, load
from hybrid_rl.thesis.studies.dots import ROW_HEIGHT, row_points
from hybrid_rl.thesis.studies.recorded import labels
from hybrid_rl.training.rollout import rollout_with_actions
from hybrid_rl.types import Params, Spec

SETS = ("learned policies", "random actions")
START = 1_000_000  # first key of the episodes, which no evaluation uses


class RandomActions:
    """Uniform actions."""

    def init(self, spec: Spec) -> Array:
        """An action that gives the size."""
        return jnp.zeros(spec.act)

    def act(self, params: Params, state: Array, obs: Array, key: Array) -> tuple[Any, ...]:
        """Action [m], the state, no metrics."""
        return jax.random.uniform(key, state.shape, minval=-1, maxval=1), state, {}


def figure(
    runs: Annotated[str, "run folders of one task; a pattern in quotes"],
    decisions: Annotated[int, "of each kind, drawn from the episodes", whole(10)] = 20000,
) -> tuple[Any, dict[str, Any]]:
    """Errors of each run on both kinds of decisions."""
    folders = find(runs)
    trained = [load(folder, "runs") for folder in folders]
    if len({run.task for run in trained}) > 1 or any(run.params.model is None for run in trained):
        raise UsageError(f"runs={runs}: needs runs of one task, each with a learned model")
    data = held_out(trained, decisions)
    numbers: dict[str, Any] = {"decisions": decisions, "runs": {}}
    for label, run in zip(labels(folders), trained, strict=True):
        each = {kind: errors(run, *data[kind]) for kind in SETS}
        numbers["runs"][f"{label}, {run.step:,}"] = {"step": run.step, "seeds": list(run.seeds)} | {
            kind: {"iqm": iqm(e), "band": band(e), "each": e} for kind, e in each.items()
        }
    return draw(numbers), numbers


def summary(numbers: dict[str, Any]) -> list[str]:
    """A line per run."""
    lines = []
    for name, one in numbers["runs"].items():
        parts = []
        for kind in SETS:
            low, high = one[kind]["band"]
            parts.append(f"{kind} {one[kind]['iqm']:.3f} [{low:.3f}, {high:.3f}]")
        lines.append(f"{name} decisions: {', '.join(parts)}")
    return lines


def held_out(trained: list[Trained], decisions: int) -> dict[str, tuple[Array, Array, Array]]:
    """Kind -> observations [N, o], actions [N, m] and next observations [N, o]."""
    most = max(run.step for run in trained)
    rng, parts = np.random.default_rng(0), {kind: [] for kind in SETS}
    for run in trained:
        if run.step == most:
            controller = run.controllers.get("policy", run.controllers["full"])
            parts[SETS[0]].append(episodes(run, controller))
    parts[SETS[1]].append(episodes(trained[0], RandomActions()))
    result = {}
    for kind, each in parts.items():
        share = decisions // len(each)
        chosen = [rng.integers(len(obs), size=share) for obs, *_ in each]
        result[kind] = tuple(
            jnp.concatenate([a[rows] for a, rows in zip(column, chosen, strict=True)])
            for column in zip(*each, strict=True)
        )
    return result


def episodes(run: Trained, controller: Any) -> tuple[np.ndarray, ...]:
    """obs [N, o], action [N, m], next_obs [N, o] of one episode of each seed."""
    keys = jax.vmap(jax.random.key)(START + jnp.array(run.seeds))
    world = run.episode

    def one(params: Params, key: Array) -> Any:
        return rollout_with_actions(world, controller, params, key, world.steps)

    actions, states = jax.tree.map(np.asarray, jax.jit(jax.vmap(one))(run.params, keys))
    lived = ~states.done[:, :-1]
    return states.obs[:, :-1][lived], actions[lived], states.obs[:, 1:][lived]


def errors(run: Trained, obs: Array, action: Array, after: Array) -> np.ndarray:
    """The error [S] of the model of each seed."""
    assert run.agent is not None  # only a policy of a file has none
    learner: Any = run.agent.learners["model"]
    scale = jnp.var(after - obs, 0)

    def one(params: Any) -> Array:
        predicted = jax.vmap(learner.model.step, (None, 0, 0))(params, obs, action)
        return jnp.sqrt(jnp.mean(jnp.mean((predicted - after) ** 2, 0) / scale))

    return np.asarray(jax.jit(lambda params: jax.lax.map(one, params))(run.params.model))


def draw(numbers: dict[str, Any]) -> Any:
    """A panel for each kind of decisions, a point with its band for each run; grey: each seed."""
    runs = numbers["runs"]
    steps = [f"{int(one['step']):,}" for one in runs.values()]
    names = [run.removesuffix(step).rstrip(" ,:") for run, step in zip(runs, steps, strict=True)]
    entries = [f"{words(name)}, {step} decisions" for name, step in zip(names, steps, strict=True)]
    figure = blank(8, 1.0 + ROW_HEIGHT * len(runs))
    for axes, kind in zip(figure.subplots(1, 2, sharey=True), SETS, strict=True):
        for row, one in enumerate(runs.values()):
            each = one[kind]["each"]
            axes.plot(each, [row] * len(each), ".", color="#BBBBBB")
        spreads = {run: [[one[kind]["iqm"], *one[kind]["band"]]] for run, one in runs.items()}
        row_points(axes, spreads, entries=entries)
        axes.set(title=f"on {kind}", xlabel="held-out error")
    return figure
