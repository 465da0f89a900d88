"""Worlds that are formulas against energy, equilibrium, MuJoCo C and SciPy."""

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hybrid_rl.envs.analytic import cart_double_pendulum as cart
from hybrid_rl.envs.analytic import integrate
from hybrid_rl.envs.analytic import quadcopter_se3 as quad
from hybrid_rl.envs.analytic.cart_double_pendulum import CartDoublePendulum
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.analytic.point_mass import DT, PUSH, PointMass
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.envs.mujoco import mjcf

EACH = [PointMass(), CartDoublePendulum(), QuadcopterSE3(), QuadcopterSE3(drag=False), Pendulum()]
over_worlds = pytest.mark.parametrize("world", EACH, ids=repr)


@over_worlds
def test_rest_is_an_equilibrium(world) -> None:
    with jax.enable_x64(True):
        x, u = world.equilibrium()
        np.testing.assert_allclose(world.dynamics(x, u), x, atol=1e-12)
        np.testing.assert_array_equal(world.to_local(x), 0)
    assert np.abs(u).max() < 1


@over_worlds
def test_place_is_the_inverse_of_deviation(world) -> None:
    with jax.enable_x64(True):
        size = world.to_local(world.equilibrium()[0]).size
        e = jnp.asarray(np.random.default_rng(0).uniform(-0.4, 0.4, size))
        np.testing.assert_allclose(world.to_local(world.from_local(e)), e, atol=1e-12)


@over_worlds
def test_flow_is_what_a_step_shows(world) -> None:
    state = world.reset(jax.random.key(3))
    u = jnp.linspace(-0.5, 0.7, world.spec.act)
    np.testing.assert_allclose(world.dynamics(state.obs, u), world.step(state, u).obs, atol=1e-5)


def follow(world, x, actions) -> np.ndarray:
    """States [T+1, o]."""
    with jax.enable_x64(True):
        run = jax.jit(
            lambda x, u: jax.lax.scan(lambda x, u: (world.dynamics(x, u),) * 2, x, u)[1],
        )
        x = jnp.asarray(x, jnp.float64)
        return np.concatenate([x[None], run(x, jnp.asarray(actions))])


START = np.array([0.3, 0.4, -0.3, 0.5, -1.0, 2.0])


def test_cart_double_pendulum_against_mujoco() -> None:
    """Half a second with a motor that changes, MuJoCo at a twentieth of the step."""
    rng = np.random.default_rng(0)
    actions = rng.uniform(-1, 1, (50, 1))
    model = mjcf.load("cart_double_pendulum.xml")
    data = mujoco.MjData(model)
    assert model.opt.timestep == 0.001
    data.qpos[:] = [START[0], START[1], START[2] - START[1]]
    data.qvel[:] = [START[3], START[4], START[5] - START[4]]
    found = follow(CartDoublePendulum(), START, actions)
    for u, x in zip(actions, found[1:], strict=True):
        data.qfrc_applied[0] = cart.FORCE * u[0]
        mujoco.mj_step(model, data, 10)
        q, v = data.qpos, data.qvel
        wanted = [q[0], q[1], q[1] + q[2], v[0], v[1], v[1] + v[2]]
        np.testing.assert_allclose(x, wanted, atol=2e-5)
    assert np.ptp(found[:, 1:3]) > 1  # it did fall about


def test_cart_double_pendulum_keeps_its_energy() -> None:
    """By MuJoCo's own account of it: over two seconds of falling, in steps of a millisecond."""

    def fine(x, _):
        x = integrate.rk4(lambda x: cart._rate(x, 0.0 * x[0]), x, 0.001)
        return x, x

    with jax.enable_x64(True):
        path = jax.lax.scan(fine, jnp.asarray(START), None, length=2000)[1]
    model = mjcf.load("cart_double_pendulum.xml")
    data, energies = mujoco.MjData(model), []
    for x in np.asarray(path)[::100]:
        data.qpos[:] = [x[0], x[1], x[2] - x[1]]
        data.qvel[:] = [x[3], x[4], x[5] - x[4]]
        mujoco.mj_forward(model, data)
        mujoco.mj_energyPos(model, data)
        mujoco.mj_energyVel(model, data)
        energies.append(data.energy.sum())
    assert np.ptp(energies) < 1e-5 * abs(energies[0])


def twisted() -> np.ndarray:
    """A quadcopter [18] that turns and flies."""
    with jax.enable_x64(True):
        e = jnp.array([0.1, -0.2, 0.3, 0.2, -0.3, 0.1, 1.0, -0.5, 0.7, 2.0, -1.0, 1.5])
        return np.asarray(QuadcopterSE3().from_local(e))


def test_quadcopter_against_an_accurate_integration() -> None:
    """Euler's and Newton's equations in the frame of the world, by SciPy."""
    u = np.array([0.6, 0.3, 0.5, 0.2])
    inertia, w_b = np.array(quad.INERTIA), quad.THRUST * u

    def rate(_, x):
        R, v, w = x[3:12].reshape(3, 3), x[12:15], x[15:]  # v in the frame of the world
        force = R @ [0, 0, quad.KT * w_b.sum()] / quad.MASS - [0, 0, quad.G]
        torque = [
            quad.KT * quad.ARM * (w_b[1] - w_b[3]),
            quad.KT * quad.ARM * (w_b[2] - w_b[0]),
            quad.KM * (w_b[0] - w_b[1] + w_b[2] - w_b[3]),
        ]
        turn = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        spin = np.linalg.solve(np.diag(inertia), torque - np.cross(w, inertia * w))
        return np.concatenate([v, (R @ turn).ravel(), force, spin])

    x = twisted()
    start = x.copy()
    start[12:15] = x[3:12].reshape(3, 3) @ x[12:15]
    end = solve_ivp(rate, (0, 0.5), start, rtol=1e-11, atol=1e-12).y[:, -1]
    end[12:15] = end[3:12].reshape(3, 3).T @ end[12:15]
    got = follow(QuadcopterSE3(drag=False), x, np.tile(u, (100, 1)))[-1]
    np.testing.assert_allclose(got, end, atol=1e-6)


def test_quadcopter_falls_with_its_energy_and_drag_takes_some() -> None:
    def energy(x):
        fall = quad.MASS * (0.5 * np.sum(x[12:15] ** 2) + quad.G * x[2])
        return fall + 0.5 * np.sum(quad.INERTIA * x[15:] ** 2)

    for world, loses in ((QuadcopterSE3(drag=False), False), (QuadcopterSE3(), True)):
        path = follow(world, twisted(), np.zeros((100, 4)))
        lost = energy(path[0]) - energy(path[-1])
        assert (lost > 0.1) if loses else abs(lost) < 1e-6


def test_quadcopter_stays_a_rotation() -> None:
    R = follow(QuadcopterSE3(), twisted(), np.full((1200, 4), 0.2))[-1, 3:12].reshape(3, 3)
    np.testing.assert_allclose(R.T @ R, np.eye(3), atol=1e-9)


def test_point_mass_by_hand() -> None:
    got = follow(PointMass(), [0.1, 0.2, 0.3, 0.0], np.tile([1.0, -0.5], (10, 1)))[-1]
    t = 10 * DT
    half = 0.5 * PUSH * t**2
    np.testing.assert_allclose(got[:2], [0.1 + 0.3 * t + half, 0.2 - 0.5 * half], atol=1e-12)


def test_scenes_show_the_same_body() -> None:
    """The tip of the second rod, and the nose of the quadcopter."""
    model = mjcf.load("cart_double_pendulum.xml")
    data, world = mujoco.MjData(model), CartDoublePendulum()
    data.qpos[:] = world.pose(integrate.state(jnp.asarray(START), jnp.zeros(())))
    mujoco.mj_forward(model, data)
    elbow = [START[0] + 0.5 * np.sin(0.4), 0, 0.5 * np.cos(0.4)]
    np.testing.assert_allclose(data.body("upper").xpos, elbow, atol=1e-6)
    up = data.body("upper").xmat.reshape(3, 3)[:, 2]
    np.testing.assert_allclose(up, [np.sin(-0.3), 0, np.cos(-0.3)], atol=1e-6)
    model = mjcf.load("quadcopter_se3.xml")
    data, x = mujoco.MjData(model), twisted()
    data.qpos[:] = QuadcopterSE3().pose(integrate.state(jnp.asarray(x), jnp.zeros(())))
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.body("frame").xmat, x[3:12], atol=1e-5)


def test_highest_hill() -> None:
    x = np.linspace(-1, 1, 2001)
    phi = np.asarray(integrate.hills(jnp.asarray(x)))
    assert x[phi.argmax()] == pytest.approx(0.65)
    assert phi.max() == pytest.approx(1.0, abs=1e-5)
    assert np.sum((phi[1:-1] > phi[:-2]) & (phi[1:-1] > phi[2:])) == 3


def test_falling_ends_the_episode() -> None:
    world = CartDoublePendulum()
    lying = integrate.state(jnp.array([0.0, 1.56, 0.0, 0.0, 5.0, 0.0]), jnp.zeros(()))
    assert world.step(lying, jnp.zeros(1)).terminated
    assert not world.step(world.reset(jax.random.key(0)), jnp.zeros(1)).terminated
    over = integrate.state(jnp.asarray(twisted()).at[11].set(-0.5), jnp.zeros(()))
    assert QuadcopterSE3().step(over, jnp.zeros(4)).terminated
