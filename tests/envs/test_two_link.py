"""The two-link arm against energy and MuJoCo C."""

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import follow, jitted, placed, simulated

from hybrid_rl.envs.analytic import two_link
from hybrid_rl.envs.analytic.two_link import TwoLink

ARM, FREE, ASSET = TwoLink(), TwoLink(friction=0.0), "two_link.xml"


def energies(positions, velocities) -> np.ndarray:
    """As MuJoCo computes them [T], of the joint positions and velocities [T, nv]."""
    values = []
    for qpos, qvel in zip(positions, velocities, strict=True):
        model, data = placed(ASSET, qpos, qvel)
        mujoco.mj_energyPos(model, data)
        mujoco.mj_energyVel(model, data)
        values.append(data.energy.sum())
    return np.array(values)


@pytest.mark.parametrize(("arm", "friction"), [(FREE, 0.0), (ARM, 1e-4)], ids=["free", "friction"])
def test_energy_is_lost_to_friction_alone(arm, friction) -> None:
    """At the rate d |q'|^2, integrated by the trapezoidal rule."""
    path = follow(arm, [0.3, 15.0, -0.4, -8.0, 0.0, 0.0], np.zeros((100, 2)))
    energy = energies(path[:, [0, 2, 4, 5]], path[:, [1, 3, 4, 5]])
    lost = np.trapezoid(friction * (path[:, 1] ** 2 + path[:, 3] ** 2), dx=two_link.DT)
    assert np.ptp(energy) == pytest.approx(lost, rel=1e-3, abs=1e-6 * energy.max())
    assert np.ptp(path[:, 2]) > 0.5
    assert friction == 0 or lost > 0.1 * energy[0]


def test_it_moves_as_in_mujoco() -> None:
    """One second under random torques; MuJoCo C has no friction."""
    u = np.random.default_rng(0).uniform(-0.3, 0.3, (100, 2))
    path = follow(FREE, [0.3, 1.0, -0.4, -2.0, 1.0, 2.0], u)[1:]
    forces = np.pad(two_link.TORQUE * u, ((0, 0), (0, 2)))
    q, v = simulated(ASSET, [0.3, -0.4, 0, 0], [1.0, -2.0, 0, 0], forces, 10)
    expected = np.column_stack([q[:, 0], v[:, 0], q[:, 1], v[:, 1]])
    np.testing.assert_allclose(path[:, :4], expected, atol=1e-4)
    np.testing.assert_array_equal(path[:, 4:], [[1.0, 2.0]] * 100)
    assert np.ptp(path[:, 2]) > 1


def test_it_starts_at_rest_with_a_target_in_reach() -> None:
    keys = jax.random.split(jax.random.key(0), 500)
    obs = np.asarray(jax.vmap(TwoLink(reach=1.5).reset)(keys).obs)
    np.testing.assert_array_equal(obs[:, :4], 0)
    assert 1.4 < np.abs(obs[:, 4:]).max() <= 1.5
    np.testing.assert_allclose(obs[:, 4:].std(axis=0), 1.5 / np.sqrt(3), rtol=0.1)


def test_its_reference_is_its_target_at_rest() -> None:
    now, later = ARM.reference(jnp.array([0.1, 0.2, 0.3, 0.4, -1.0, 2.0]))
    np.testing.assert_array_equal(now, [-1, 0, 2, 0, -1, 2])
    np.testing.assert_array_equal(later, now)
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
