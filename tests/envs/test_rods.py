"""Cart pendulum and two-link arm against energy and MuJoCo C."""

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import follow, jitted

from hybrid_rl.envs.analytic import cart_pendulum, two_link
from hybrid_rl.envs.analytic.cart_pendulum import CartPendulum
from hybrid_rl.envs.analytic.state import fully_observed
from hybrid_rl.envs.analytic.two_link import TwoLink
from hybrid_rl.envs.mujoco import mjcf

CART, ARM = CartPendulum(), TwoLink()
FREE = TwoLink(friction=0.0)


def energies(asset, positions, velocities) -> np.ndarray:
    """As MuJoCo computes them [T], of the joint positions and velocities [T, nv]."""
    model = mjcf.load(asset)
    data, values = mujoco.MjData(model), []
    for data.qpos[:], data.qvel[:] in zip(positions, velocities, strict=True):
        mujoco.mj_forward(model, data)
        mujoco.mj_energyPos(model, data)
        mujoco.mj_energyVel(model, data)
        values.append(data.energy.sum())
    return np.array(values)


def simulated(asset, qpos, qvel, forces, steps) -> tuple[np.ndarray, np.ndarray]:
    """Joint positions and velocities [T, nv] of MuJoCo C under generalised forces [T, nv]."""
    model = mjcf.load(asset)
    data, path = mujoco.MjData(model), []
    data.qpos[:], data.qvel[:] = qpos, qvel
    for data.qfrc_applied[:] in forces:
        mujoco.mj_step(model, data, steps)
        path.append((data.qpos.copy(), data.qvel.copy()))
    positions, velocities = zip(*path, strict=True)
    return np.array(positions), np.array(velocities)


def test_cart_pendulum_conserves_energy() -> None:
    """A second of falling through the lowest point."""
    path = follow(CART, [0.3, 0.4, 1.0, 0.5], np.zeros((50, 1)))
    energy = energies("cart_pendulum.xml", path[:, 1::-1], path[:, :1:-1])
    assert np.ptp(path[:, 0]) > np.pi
    assert np.ptp(energy) < 1e-6 * np.abs(energy).max()


def test_two_link_conserves_energy_without_friction() -> None:
    path = follow(FREE, [0.3, 15.0, -0.4, -8.0, 0.0, 0.0], np.zeros((100, 2)))
    energy = energies("two_link.xml", path[:, [0, 2, 4, 5]], path[:, [1, 3, 4, 5]])
    assert np.ptp(path[:, 2]) > 0.5
    assert np.ptp(energy) < 1e-6 * energy.max()


def test_two_link_loses_energy_to_friction() -> None:
    """At the rate d |q'|^2, integrated by the trapezoidal rule."""
    path = follow(ARM, [0.3, 15.0, -0.4, -8.0, 0.0, 0.0], np.zeros((100, 2)))
    energy = energies("two_link.xml", path[:, [0, 2, 4, 5]], path[:, [1, 3, 4, 5]])
    lost = np.trapezoid(1e-4 * (path[:, 1] ** 2 + path[:, 3] ** 2), dx=two_link.DT)
    assert energy[0] - energy[-1] == pytest.approx(lost, rel=1e-3)
    assert lost > 0.1 * energy[0]


def test_cart_pendulum_against_mujoco() -> None:
    """One second under random forces."""
    u = np.random.default_rng(0).uniform(-1, 1, (50, 1))
    path = follow(CART, [0.1, -0.2, 0.3, 0.4], u)[1:]
    forces = np.pad(CART.force * u, ((0, 0), (0, 1)))
    q, v = simulated("cart_pendulum.xml", [-0.2, 0.1], [0.4, 0.3], forces, 20)
    np.testing.assert_allclose(path, np.column_stack([q[:, ::-1], v[:, ::-1]]), atol=1e-5)
    assert np.ptp(path[:, 0]) > 1


def test_two_link_against_mujoco() -> None:
    """One second under random torques; MuJoCo C has no friction."""
    u = np.random.default_rng(0).uniform(-0.3, 0.3, (100, 2))
    path = follow(FREE, [0.3, 1.0, -0.4, -2.0, 1.0, 2.0], u)[1:]
    forces = np.pad(two_link.TORQUE * u, ((0, 0), (0, 2)))
    q, v = simulated("two_link.xml", [0.3, -0.4, 0, 0], [1.0, -2.0, 0, 0], forces, 10)
    expected = np.column_stack([q[:, 0], v[:, 0], q[:, 1], v[:, 1]])
    np.testing.assert_allclose(path[:, :4], expected, atol=1e-4)
    np.testing.assert_array_equal(path[:, 4:], [[1.0, 2.0]] * 100)
    assert np.ptp(path[:, 2]) > 1


@pytest.mark.parametrize("entry", [0, 1])
def test_leaving_the_bounds_ends_the_episode(entry) -> None:
    """Of the angle or the position; success is being inside."""
    env = CartPendulum(angle_limit=0.3, position_limit=1.0)
    limit = (0.3, 1.0)[entry]
    for factor, inside in ((0.9, True), (1.1, False), (-1.1, False)):
        state = fully_observed(jnp.zeros(4).at[entry].set(factor * limit), jnp.zeros(()))
        after = jitted(env, "step")(state, jnp.zeros(1))
        assert bool(after.terminated) is not inside
        assert after.metrics["success"] == inside
    assert after.reward == pytest.approx(np.cos(after.obs[0]) - 0.1 * after.obs[1] ** 2)


def test_the_arm_starts_at_rest_with_a_target_in_reach() -> None:
    obs = np.asarray(
        jax.vmap(TwoLink(reach=1.5).reset)(jax.random.split(jax.random.key(0), 500)).obs
    )
    np.testing.assert_array_equal(obs[:, :4], 0)
    assert 1.4 < np.abs(obs[:, 4:]).max() <= 1.5
    np.testing.assert_allclose(obs[:, 4:].std(axis=0), 1.5 / np.sqrt(3), rtol=0.1)


def test_the_reference_of_the_arm_is_its_target_at_rest() -> None:
    now, later = ARM.reference(jnp.array([0.1, 0.2, 0.3, 0.4, -1.0, 2.0]))
    np.testing.assert_array_equal(now, [-1, 0, 2, 0, -1, 2])
    np.testing.assert_array_equal(later, now)
    np.testing.assert_array_equal(ARM.to_local(now), 0)
    np.testing.assert_allclose(jax.jit(ARM.dynamics)(now, jnp.zeros(2)), now, atol=1e-6)


@pytest.mark.parametrize(("away", "success"), [(0.03, 1.0), (0.04, 0.0)])
def test_success_of_the_arm_is_within_its_distance(away, success) -> None:
    state = ARM.reset(jax.random.key(0))
    target = state.info["target"] + jnp.array([away, -away])
    at = jnp.zeros(4).at[::2].set(target)
    after = jitted(ARM, "step")(state.replace(data=at), jnp.zeros(2))
    assert after.metrics["distance"] == pytest.approx(away * np.sqrt(2), abs=1e-5)
    assert after.metrics["success"] == success
    assert after.reward == pytest.approx(-30 * away**2, rel=1e-3)


def test_scenes_show_the_rods() -> None:
    """The top of a rod of another length, the tips of the arm and of its target."""
    env = CartPendulum(length=1.2)
    model = mujoco.MjModel.from_xml_string(env.scene())
    data = mujoco.MjData(model)
    data.qpos[:] = env.pose(fully_observed(jnp.array([0.3, 0.5, 0, 0]), jnp.zeros(())))
    mujoco.mj_forward(model, data)
    middle = [0.5 + 0.6 * np.sin(0.3), 0, 0.6 * np.cos(0.3)]
    np.testing.assert_allclose(data.geom("rod").xpos, middle, atol=1e-6)
    model = mjcf.load("two_link.xml")
    data, state = mujoco.MjData(model), ARM.reset(jax.random.key(0))
    state = state.replace(data=jnp.array([0.4, 0.0, 0.5, 0.0]))
    data.qpos[:] = ARM.pose(state)
    mujoco.mj_forward(model, data)
    for name, (a, b) in (("tip", (0.4, 0.5)), ("tip_target", np.asarray(state.info["target"]))):
        tip = 0.1 * np.array([np.cos(a) + np.cos(a + b), np.sin(a) + np.sin(a + b)])
        np.testing.assert_allclose(data.geom(name).xpos[:2], tip, atol=1e-6)


@pytest.mark.parametrize(
    ("env", "fields", "line"),
    [
        (CartPendulum, {"length": 0.0}, "length=0.0: must be above 0"),
        (CartPendulum, {"start": -1}, "start=-1: must be above 0"),
        (TwoLink, {"friction": -1e-4}, "friction=-0.0001: must be 0 or more"),
        (TwoLink, {"reach": 0}, "reach=0: must be above 0"),
    ],
)
def test_bad_fields_are_named(env, fields, line) -> None:
    with pytest.raises(ValueError, match=line):
        env(**fields)


def test_masses_are_those_of_cartpole() -> None:
    model = mjcf.load("cartpole.xml")
    masses = [model.body(name).mass[0] for name in ("cart", "pole")]
    np.testing.assert_allclose([CART.cart_mass, CART.rod_mass], masses)
    assert CART.length == pytest.approx(2 * model.geom("pole").size[1])
    assert CART.force == model.actuator("slider").gear[0]
    assert cart_pendulum.G == -mjcf.load("cart_pendulum.xml").opt.gravity[2]
