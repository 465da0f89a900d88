"""The distribution over returns of a critic."""

import math

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.critics.categorical_q import CategoricalQ


def test_the_target_is_the_projection_of_bellemare_et_al() -> None:
    """Against their Algorithm 1, written as loops; its mean is the Bellman target."""
    critic = CategoricalQ(hidden=(8,), bins=11, bound=2.0)
    rng = np.random.default_rng(0)
    p = rng.dirichlet(np.ones(11), size=(2, 4))
    reward, factor = np.array([0.1, -0.3, 0.0, 9.0]), np.array([0.9, 0.5, 0.0, 0.9])
    penalty = np.array([0.05, -0.1, 0.3, 0.0])
    z = np.linspace(-2, 2, 11)
    expected = np.zeros((4, 11))
    for i in range(4):
        least = min(range(2), key=lambda k: p[k, i] @ z)
        for k in range(11):
            y = min(max(reward[i] + factor[i] * (z[k] - penalty[i]), -2), 2)
            at = (y + 2) / 0.4
            low, high = math.floor(at + 1e-9), math.ceil(at - 1e-9)
            expected[i, low] += p[least, i, k] * (high - at if high > low else 1)
            expected[i, high] += p[least, i, k] * (at - low) if high > low else 0
    made = jax.jit(critic.target)(jnp.log(p), *map(jnp.float32, (reward, factor, penalty)))
    np.testing.assert_allclose(made, expected, atol=2e-5)
    mean = reward + factor * ((p @ z).min(0) - penalty)
    np.testing.assert_allclose((np.asarray(made) @ z)[:3], mean[:3], atol=1e-4)  # not clipped
