"""Eight decisions, with learning, of any task and method, whose parts are made small."""

from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from omegaconf import DictConfig
from tiny import SMALL, demonstrate

from hybrid_rl.run.members import loop_of
from hybrid_rl.settings import build as config

LINEAR = ("koopman", "gp_")  # begin the names of methods without networks to shrink


def put(node: Any, **values: Any) -> None:
    """Set every key of these names in a composed configuration, here and below.

    A teacher keeps its values.
    """
    for key, value in node.items():
        if key in values:
            node[key] = values[key]
        elif isinstance(value, DictConfig) and key != "teacher":
            put(value, **values)


def with_demonstrations(composed: DictConfig, folder: Path) -> DictConfig:
    """The configuration with a file of random decisions, if its method learns from one."""
    learners = composed.learners.values()
    shown = any(each and each.get("demonstrations") for each in learners)
    if shown or composed.replay.demonstrations:
        put(composed, file=demonstrate(folder, composed).partition("=")[2])
    return composed


def load(algo: str, *overrides: str) -> DictConfig:
    """The configuration of two learners of this method, of small parts."""
    linear = algo.startswith(LINEAR)
    small = ["total_steps=200"] if linear else SMALL
    composed = config.load([f"algo={algo}", *overrides, "num_seeds=2", *small])
    if linear:
        put(composed.controllers, horizon=2, size=4)
        put(composed.learners, horizon=2, size=4)
    for parts in (composed.controllers, composed.learners):
        put(parts, hidden=[8], particles=20, moves=1, batch_size=2)
    if composed.task != "pendulum" and composed.learners.get("policy"):
        put(composed.learners.policy, updates=1)
    composed.pretrain, composed.random_steps = min(composed.pretrain, 2), 2
    return composed


def trace(agent: Any) -> None:
    """Fail unless a decision has the shapes of the state before it."""
    state = jax.eval_shape(agent.init, jax.random.key(0))
    after, metrics = jax.eval_shape(agent.step, state, jnp.int32(0))
    sizes = [jax.tree.map(lambda x: (x.shape, x.dtype.name), each) for each in (state, after)]
    assert jax.tree.structure(state) == jax.tree.structure(after)
    assert jax.tree.leaves(sizes[0]) == jax.tree.leaves(sizes[1])
    assert metrics


def learn(run: Any) -> None:
    """Eight decisions of all learners; all numbers are finite."""
    loop = loop_of(run.agent, run.seeds, stride=8)
    state = loop.init()
    program = loop.compile(state)
    state, metrics = program(state, jnp.int32(0), jnp.int32(8))
    assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(run.agent.params(state)))
    demonstrated = run.agent.replay.num_demonstrated(run.agent.num_envs)
    assert (state.memory.count - demonstrated == 8).all()
    learned = [name for name in metrics if name.endswith("_loss") or name == "model/loss"]
    assert learned or not run.agent.learners
    for name in learned:
        assert np.isfinite(metrics[name][-1]).all()
