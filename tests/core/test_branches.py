"""Branches that are kept, in a model whose every step is known."""

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core import branches
from hybrid_rl.run.start import forgotten
from hybrid_rl.types import Batch

B = 10


def counting(x: Array, for_policy: Array, for_model: Array, key: Array) -> Batch:
    """x' = x + 1; action -x, reward x; the episode is likely to end above 2.5."""
    ended = jnp.where(x[:, 0] > 2.5, 0.6, 0.4)
    return Batch(x, -x[:, :1], x[:, 0], ended, 0 * ended, x + 1)


def recalled(start: Array | float, steps: int, updates: int, margin: float | None = None) -> Batch:
    """Transitions after some updates, with eight in memory for each branch."""
    first = jnp.broadcast_to(start, (B, jnp.shape(start)[-1] if jnp.ndim(start) else 1))
    kept = branches.begin(B, 8 * B, first.shape[1], 1, steps)
    extend = jax.jit(
        lambda kept, key: branches.extended(kept, counting, first, 1, steps, key, margin)
    )
    for key in jax.random.split(jax.random.key(3), updates):
        kept = extend(kept, key)
    return branches.sample_kept(kept, jax.random.key(4))


def test_branches_reach_every_length() -> None:
    """From -9, where nothing ends, to -9 + steps: one decision of the model per update."""
    np.testing.assert_array_equal(recalled(-9.0, 4, 1).obs[:, 0], -9)
    batch = recalled(-9.0, 4, 30)
    at = np.asarray(batch.obs[:, 0])
    assert set(at) == {-9.0, -8.0, -7.0, -6.0}
    np.testing.assert_array_equal(batch.reward, at)
    np.testing.assert_array_equal(batch.action[:, 0], -at)
    np.testing.assert_array_equal(batch.next_obs[:, 0], at + 1)


def test_a_branch_that_ended_restarts() -> None:
    batch = recalled(1.0, 9, 30)
    assert set(np.asarray(batch.obs[:, 0])) == {1.0, 2.0, 3.0}
    np.testing.assert_allclose(batch.terminated, np.where(batch.obs[:, 0] > 2.5, 0.6, 0.4))


def test_forgotten_branches_start_again() -> None:
    """Also inside the state of a learner; no older transition is drawn. Before, all ages."""
    old, first = branches.begin(B, 8 * B, 1, 1, 4, whole=False), jnp.full((B, 1), -9.0)
    for key in jax.random.split(jax.random.key(3), 10):
        old = branches.extended(old, counting, first, 1, 4, key)
    assert set(np.asarray(old.x[:, 0])) == {-8.0, -7.0, -6.0, -5.0}
    kept = forgotten({"kept": old, "other": 1})["kept"]
    kept = branches.extended(kept, counting, first - 20, 1, 4, jax.random.key(5))
    batch = branches.sample_kept(kept, jax.random.key(4))
    np.testing.assert_array_equal(batch.obs, -29)
    np.testing.assert_array_equal(batch.reward, -29)
    assert (batch.action, batch.terminated, batch.next_obs) == (None, None, None)  # not kept


def test_a_branch_ends_outside_of_the_real_range() -> None:
    """Starts from -9 to -7, margin 0.75: it ends above -5.5. A constant entry does not count."""
    first = jnp.stack([jnp.linspace(-9, -7, B), jnp.full(B, -5.0)], -1)
    assert recalled(first, 20, 30).obs[:, 0].max() > 0
    near = recalled(first, 20, 30, margin=0.75)
    assert -6.5 < near.obs[:, 0].max() <= -5.5
    assert near.obs[:, 1].max() > -5
    beyond = jnp.stack([jnp.array([-10.6, -10.4, -5.6, -5.4]), jnp.full(4, -5.0)], -1)
    np.testing.assert_array_equal(branches._far(beyond, first, 0.75), [True, False, False, True])
