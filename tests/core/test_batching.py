"""Trees of arrays: a state of an environment as one array."""

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.core.batching import of_words, words
from hybrid_rl.envs.analytic.two_link import TwoLink


def test_a_state_is_packed_without_loss():
    """Keys, counters and flags among numbers."""
    state = jax.jit(TwoLink().reset)(jax.random.key(0))
    new = jax.random.key(5)
    more = {"new": new, "key": jnp.array([1, 2**32 - 1], jnp.uint32), "count": jnp.int32(-3)}
    more |= {"flag": jnp.array(True), "all": jnp.array([1.5, -jnp.inf])}
    state = state.replace(info={**state.info, **more})
    like = jax.eval_shape(lambda: state)
    again = jax.jit(lambda x: of_words(words(x), like))(state)
    assert (jax.random.key_data(again.info.pop("new")) == jax.random.key_data(new)).all()
    state.info.pop("new")
    jax.tree.map(np.testing.assert_array_equal, again, state)
    assert jax.tree.map(lambda x: x.dtype, again) == jax.tree.map(lambda x: x.dtype, state)
