"""The two-link arm against MuJoCo C."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from worlds import follow, jitted, simulated

from hybrid_rl.envs.analytic import two_link
from hybrid_rl.envs.analytic.two_link import TwoLink
from hybrid_rl.envs.mujoco import mjcf

ARM, JOINTS = TwoLink(), ("shoulder", "elbow")


@pytest.mark.parametrize("friction", [0.0, 1e-4])
def test_it_moves_as_in_mujoco(friction) -> None:
    """One second under random torques."""
    u = np.random.default_rng(0).uniform(-0.3, 0.3, (100, 2))
    path = follow(TwoLink(friction), [0.3, 1.0, -0.4, -2.0, 1.0, 2.0], u)[1:]
    forces = np.pad(two_link.TORQUE * u, ((0, 0), (0, 2)))
    asset = mjcf.changed("two_link.xml", {f"joint.{name}.damping": friction for name in JOINTS})
    q, v = simulated(asset, [0.3, -0.4, 0, 0], [1.0, -2.0, 0, 0], forces, 10)
    expected = np.column_stack([q[:, 0], v[:, 0], q[:, 1], v[:, 1]])
    np.testing.assert_allclose(path[:, :4], expected, atol=1e-4)
    np.testing.assert_array_equal(path[:, 4:], [[1.0, 2.0]] * 100)
    assert np.ptp(path[:, 2]) > 1


def test_it_rests_at_its_target() -> None:
    now = ARM.reference(jnp.array([0.1, 0.2, 0.3, 0.4, -1.0, 2.0]))[0]
    np.testing.assert_array_equal(now, [-1, 0, 2, 0, -1, 2])
    np.testing.assert_array_equal(ARM.to_local(now), 0)
    np.testing.assert_allclose(jitted(ARM, "dynamics")(now, jnp.zeros(2)), now, atol=1e-6)


@pytest.mark.parametrize(("away", "success"), [(0.03, 1.0), (0.04, 0.0)])
def test_success_is_within_its_distance(away, success) -> None:
    state = ARM.reset(jax.random.key(0))
    target = state.info["target"] + jnp.array([away, -away])
    at = jnp.zeros(4).at[::2].set(target)
    after = jitted(ARM, "step")(state.replace(data=at), jnp.zeros(2))
    assert after.metrics["distance"] == pytest.approx(away * np.sqrt(2), abs=1e-5)
    assert after.metrics["success"] == success
    assert after.reward == pytest.approx(-30 * away**2, rel=1e-3)
