"""Decide, observe, learn: what a world that is not JAX stands between."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import small

from hybrid_rl.settings import build as config
from hybrid_rl.training.metrics import outcome

pytestmark = pytest.mark.turns(3)

STEPS, ROUNDS = 3, 8  # decisions of an episode, and of the run


def same(one: Any, other: Any) -> None:
    """All leaves of two trees are equal, numbers but for rounding."""
    one, other = (jax.tree.map(_numbers, each) for each in (one, other))
    jax.tree.map(lambda a, b: np.testing.assert_allclose(a, b, rtol=1e-5, atol=1e-6), one, other)


def _numbers(leaf: Any) -> np.ndarray:
    is_key = jnp.issubdtype(leaf.dtype, jax.dtypes.prng_key)
    return np.asarray(jax.random.key_data(leaf) if is_key else leaf)


@pytest.mark.parametrize(
    ("algo", "resets_itself"),
    [("sac", True), ("hybrid_deterministic", False), ("koopman_active", False)],
)
def test_by_hand_they_are_a_step(algo: str, resets_itself: bool) -> None:
    """Three programs, with the world on the host between them, for two environments."""
    given = "task=point_mass", "num_envs=2", f"episode.steps={STEPS}"
    agent = config.build(small.load(algo, *given)).agent
    world: Any = jax.jit(jax.vmap(agent.episode.step))
    parts = agent.decide, agent.observe, agent.learn, agent.step
    decide, observe, learn, step = map(jax.jit, parts)
    state = jax.jit(agent.init)(jax.random.key(0))
    for i in jnp.arange(0, 2 * ROUNDS, 2):
        wanted, row = step(state, i)
        u, state, planned = decide(state, i)
        now: Any = jax.device_get(world(jax.device_get(state.env), np.asarray(u)))
        state = observe(state, u, now, wanted.env if resets_itself else None)
        state, learned = learn(state, i)
        same(state, wanted)
        same({**planned, **learned, **outcome(u, now)}, row)
    assert int(state.memory.count) == ROUNDS
