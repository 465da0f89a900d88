"""The scale of returns."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import begun

from hybrid_rl.learners.return_scale import ReturnScale
from hybrid_rl.types import Batch, Params, Spec


def test_the_scale_is_that_of_the_discounted_returns() -> None:
    """Of two environments; episodes end at times of their own."""
    rng, count = np.random.default_rng(0), 40
    reward = rng.normal(1, 2, (count, 2))
    terminated, truncated = rng.random((2, count, 2)) < 0.1
    scale = ReturnScale(discount=0.9, bound=5.0, num_envs=2)
    state, returns = begun(scale, Spec(obs=1, act=1, dt=1.0)), []
    assert float(scale.params(state)["scale"]) == 1
    blank, running, step = jnp.zeros((2, 1)), np.zeros(2), jax.jit(scale.update)
    for i in range(count):
        flags = (jnp.float32(terminated[i]), jnp.float32(truncated[i]))
        new = Batch(blank, blank, jnp.float32(reward[i]), *flags, blank)
        state, _ = step(state, Params(), new, jax.random.key(i))
        running = reward[i] + 0.9 * running
        returns.append(running)
        running = np.where(terminated[i] | truncated[i], 0, running)
    expected = max(np.std(returns), np.abs(returns).max() / 5)
    assert float(scale.params(state)["scale"]) == pytest.approx(expected, rel=1e-4)
