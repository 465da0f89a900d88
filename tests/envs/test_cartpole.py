"""Cart and pole: both rewards from their equations."""

import jax
import jax.numpy as jnp
import numpy as np
from worlds import jitted, make


def _tolerance(x, margin):
    """dm_control's `tolerance` with bounds (0, 0), Gaussian, 0.1 at the margin."""
    return np.exp(-0.5 * (np.abs(x) / margin * np.sqrt(-2 * np.log(0.1))) ** 2)


def test_rewards():
    cos, dm = make("cartpole", reward="cos"), make("cartpole", reward="dm_control")
    state = jitted(cos, "reset")(jax.random.key(0))
    for qpos, qvel, a in np.random.default_rng(0).uniform(-1, 1, (5, 3, 2)):
        now = state.replace(data=cos._body.reset(jnp.array(qpos), jnp.array(qvel)))
        action = jnp.array(a[:1], jnp.float32)
        after = jitted(cos, "step")(now, action)
        x, _, c, _, w = np.asarray(after.obs)
        np.testing.assert_allclose(after.reward, c, rtol=1e-6)
        expected = (1 + c) / 2 * (1 + _tolerance(x, 2)) / 2 * (4 + 1 - a[0] ** 2) / 5
        expected *= (1 + _tolerance(w, 5)) / 2
        np.testing.assert_allclose(jitted(dm, "step")(now, action).reward, expected, rtol=1e-5)
    top = state.replace(data=dm._body.reset(jnp.zeros(2), jnp.zeros(2)))
    np.testing.assert_allclose(jitted(dm, "step")(top, jnp.zeros(1)).reward, 1.0, atol=1e-6)
