"""Cart pendulum against MuJoCo C."""

import jax.numpy as jnp
import numpy as np
import pytest
from worlds import follow, jitted, simulated

from hybrid_rl.envs.analytic.cart_pendulum import CartPendulum
from hybrid_rl.envs.analytic.state import fully_observed

ENV, ASSET = CartPendulum(), "cart_pendulum.xml"


def test_it_moves_as_in_mujoco() -> None:
    """One second under random forces."""
    u = np.random.default_rng(0).uniform(-1, 1, (50, 1))
    path = follow(ENV, [0.1, -0.2, 0.3, 0.4], u)[1:]
    forces = np.pad(ENV.force * u, ((0, 0), (0, 1)))
    q, v = simulated(ASSET, [-0.2, 0.1], [0.4, 0.3], forces, 20)
    np.testing.assert_allclose(path, np.column_stack([q[:, ::-1], v[:, ::-1]]), atol=1e-5)
    assert np.ptp(path[:, 0]) > 1


@pytest.mark.parametrize(("entry", "limit"), [(0, 0.3), (1, 1.0)])
def test_leaving_the_bounds_ends_the_episode(entry, limit) -> None:
    """Of the angle or the position; success is being inside."""
    env = CartPendulum(angle_limit=0.3, position_limit=1.0)
    for factor, inside in ((0.9, True), (1.1, False), (-1.1, False)):
        state = fully_observed(jnp.zeros(4).at[entry].set(factor * limit), jnp.zeros(()))
        after = jitted(env, "step")(state, jnp.zeros(1))
        assert bool(after.terminated) is not inside
        assert after.metrics["success"] == inside
    assert after.reward == pytest.approx(np.cos(after.obs[0]) - 0.1 * after.obs[1] ** 2)
