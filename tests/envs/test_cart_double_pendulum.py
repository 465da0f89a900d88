"""The cart with two rods against MuJoCo C."""

import jax
import jax.numpy as jnp
import numpy as np
from worlds import follow, jitted, simulated

from hybrid_rl.envs.analytic import cart_double_pendulum as cart
from hybrid_rl.envs.analytic.state import fully_observed

ENV, ASSET = cart.CartDoublePendulum(), "cart_double_pendulum.xml"
START = np.array([0.3, 0.4, -0.3, 0.5, -1.0, 2.0])
RELATIVE = np.array([[1, 0, 0], [0, 1, 0], [0, -1, 1]])  # angles of joints, from those of rods


def test_it_moves_as_in_mujoco() -> None:
    """Half a second with a varying motor force, MuJoCo with a tenth of the step."""
    u = np.random.default_rng(0).uniform(-1, 1, (50, 1))
    path = follow(ENV, START, u)
    forces = np.pad(cart.FORCE * u, ((0, 0), (0, 2)))
    found = simulated(ASSET, RELATIVE @ START[:3], RELATIVE @ START[3:], forces, 10)
    expected = np.hstack([each @ np.linalg.inv(RELATIVE).T for each in found])
    np.testing.assert_allclose(path[1:], expected, atol=2e-5)
    assert np.ptp(path[:, 1:3]) > 1  # it fell


def test_falling_ends_the_episode() -> None:
    lying = fully_observed(jnp.array([0.0, 1.56, 0.0, 0.0, 5.0, 0.0]), jnp.zeros(()))
    for state, ends in ((lying, True), (jitted(ENV, "reset")(jax.random.key(0)), False)):
        assert jitted(ENV, "step")(state, jnp.zeros(1)).terminated == ends
