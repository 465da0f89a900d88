"""Analytic environments against energy, equilibrium, MuJoCo C and SciPy."""

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from worlds import follow, jitted

from hybrid_rl.envs.analytic import cart_double_pendulum as cart
from hybrid_rl.envs.analytic import quadcopter_se3 as quad
from hybrid_rl.envs.analytic.cart_double_pendulum import CartDoublePendulum
from hybrid_rl.envs.analytic.cart_pendulum import CartPendulum
from hybrid_rl.envs.analytic.cart_swing_up import CartSwingUp
from hybrid_rl.envs.analytic.hills import phi
from hybrid_rl.envs.analytic.integrate import rk4
from hybrid_rl.envs.analytic.lander import Lander
from hybrid_rl.envs.analytic.no_dynamics import NoDynamics
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.analytic.point_mass import ACCELERATION, DT, PointMass
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.envs.analytic.state import fully_observed
from hybrid_rl.envs.analytic.two_link import TwoLink
from hybrid_rl.envs.analytic.van_der_pol import VanDerPol
from hybrid_rl.envs.mujoco import mjcf

ENVS = [
    PointMass(),
    CartDoublePendulum(),
    QuadcopterSE3(),
    QuadcopterSE3(drag=False),
    QuadcopterSE3(turn=1.0, terminate=False),
    Pendulum(),
    NoDynamics(),
    VanDerPol(),
    CartPendulum(),
    CartSwingUp(),
    TwoLink(),
    Lander("hover"),
    Lander("flip"),
]
over_envs = pytest.mark.parametrize("env", ENVS, ids=repr)


@over_envs
def test_equilibrium_is_a_fixed_point(env) -> None:
    with jax.enable_x64(True):
        x, u = env.equilibrium()
        np.testing.assert_allclose(jax.jit(env.dynamics)(x, u), x, atol=1e-12)
        np.testing.assert_array_equal(env.to_local(x), 0)
    assert np.abs(u).max() < 1


@over_envs
def test_from_local_inverts_to_local(env) -> None:
    with jax.enable_x64(True):
        size = env.to_local(env.equilibrium()[0]).size
        e = jnp.asarray(np.random.default_rng(0).uniform(-0.4, 0.4, size))
        np.testing.assert_allclose(env.to_local(env.from_local(e)), e, atol=1e-12)


@over_envs
def test_step_follows_the_dynamics(env) -> None:
    state = jitted(env, "reset")(jax.random.key(3))
    u = jnp.linspace(-0.5, 0.7, env.spec.act)
    expected = jitted(env, "dynamics")(state.obs, u)
    np.testing.assert_allclose(jitted(env, "step")(state, u).obs, expected, atol=1e-5)


@pytest.mark.parametrize("env", [e for e in ENVS if hasattr(e, "reward_of")], ids=repr)
def test_reward_of_is_the_reward_of_a_step(env) -> None:
    state = jitted(env, "reset")(jax.random.key(5))
    u = jnp.linspace(-0.5, 0.7, env.spec.act)
    after = jitted(env, "step")(state, u)
    expected = jitted(env, "reward_of")(state.obs, u, after.obs)
    np.testing.assert_allclose(after.reward, expected, rtol=1e-5)
    assert float(after.reward) != 0


START = np.array([0.3, 0.4, -0.3, 0.5, -1.0, 2.0])


def test_cart_double_pendulum_against_mujoco() -> None:
    """Half a second with a varying motor force, MuJoCo with a tenth of the step."""
    rng = np.random.default_rng(0)
    actions = rng.uniform(-1, 1, (50, 1))
    model = mjcf.load("cart_double_pendulum.xml")
    data = mujoco.MjData(model)
    assert model.opt.timestep == 0.001
    data.qpos[:] = [START[0], START[1], START[2] - START[1]]
    data.qvel[:] = [START[3], START[4], START[5] - START[4]]
    path = follow(CartDoublePendulum(), START, actions)
    for u, x in zip(actions, path[1:], strict=True):
        data.qfrc_applied[0] = cart.FORCE * u[0]
        mujoco.mj_step(model, data, 10)
        q, v = data.qpos, data.qvel
        expected = [q[0], q[1], q[1] + q[2], v[0], v[1], v[1] + v[2]]
        np.testing.assert_allclose(x, expected, atol=2e-5)
    assert np.ptp(path[:, 1:3]) > 1  # it fell


def test_cart_double_pendulum_conserves_energy() -> None:
    """As MuJoCo computes it, over two seconds of falling in steps of a millisecond."""

    def step(x, _):
        x = rk4(lambda x: cart._rate(x, 0.0 * x[0]), x, 0.001)
        return x, x

    with jax.enable_x64(True):
        path = jax.lax.scan(step, jnp.asarray(START), None, length=2000)[1]
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
    """A state [18] of the quadcopter that rotates and moves."""
    with jax.enable_x64(True):
        e = jnp.array([0.1, -0.2, 0.3, 0.2, -0.3, 0.1, 1.0, -0.5, 0.7, 2.0, -1.0, 1.5])
        return np.asarray(QuadcopterSE3().from_local(e))


def test_quadcopter_against_an_accurate_integration() -> None:
    """The Newton-Euler equations in the world frame, by SciPy."""
    u = np.array([0.6, 0.3, 0.5, 0.2])
    inertia, w_b = np.array(quad.INERTIA), quad.THRUST * u

    def rate(_, x):
        R, v, w = x[3:12].reshape(3, 3), x[12:15], x[15:]  # v in the world frame
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
    x = follow(QuadcopterSE3(drag=False), x, np.tile(u, (100, 1)))[-1]
    np.testing.assert_allclose(x, end, atol=1e-6)


def test_quadcopter_conserves_energy_without_drag() -> None:
    def energy(x):
        linear = quad.MASS * (0.5 * np.sum(x[12:15] ** 2) + quad.G * x[2])
        return linear + 0.5 * np.sum(quad.INERTIA * x[15:] ** 2)

    for env, loses in ((QuadcopterSE3(drag=False), False), (QuadcopterSE3(), True)):
        path = follow(env, twisted(), np.zeros((100, 4)))
        lost = energy(path[0]) - energy(path[-1])
        assert (lost > 0.1) if loses else abs(lost) < 1e-6


def test_quadcopter_keeps_an_orthogonal_rotation() -> None:
    R = follow(QuadcopterSE3(), twisted(), np.full((1200, 4), 0.2))[-1, 3:12].reshape(3, 3)
    np.testing.assert_allclose(R.T @ R, np.eye(3), atol=1e-9)


def test_point_mass_in_closed_form() -> None:
    x = follow(PointMass(), [0.1, 0.2, 0.3, 0.0], np.tile([1.0, -0.5], (10, 1)))[-1]
    t = 10 * DT
    half = 0.5 * ACCELERATION * t**2
    np.testing.assert_allclose(x[:2], [0.1 + 0.3 * t + half, 0.2 - 0.5 * half], atol=1e-12)


def test_scenes_show_the_state() -> None:
    """The second rod, and the rotation of the quadcopter."""
    model = mjcf.load("cart_double_pendulum.xml")
    data, env = mujoco.MjData(model), CartDoublePendulum()
    data.qpos[:] = env.pose(fully_observed(jnp.asarray(START), jnp.zeros(())))
    mujoco.mj_forward(model, data)
    elbow = [START[0] + 0.5 * np.sin(0.4), 0, 0.5 * np.cos(0.4)]
    np.testing.assert_allclose(data.body("upper").xpos, elbow, atol=1e-6)
    up = data.body("upper").xmat.reshape(3, 3)[:, 2]
    np.testing.assert_allclose(up, [np.sin(-0.3), 0, np.cos(-0.3)], atol=1e-6)
    model = mjcf.load("quadcopter_se3.xml")
    data, x = mujoco.MjData(model), twisted()
    data.qpos[:] = QuadcopterSE3().pose(fully_observed(jnp.asarray(x), jnp.zeros(())))
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.body("frame").xmat, x[3:12], atol=1e-5)


def test_highest_hill() -> None:
    x = np.linspace(-1, 1, 2001)
    y = np.asarray(phi(jnp.asarray(x)))
    assert x[y.argmax()] == pytest.approx(0.65)
    assert y.max() == pytest.approx(1.0, abs=1e-5)
    assert np.sum((y[1:-1] > y[:-2]) & (y[1:-1] > y[2:])) == 3


def test_falling_ends_the_episode() -> None:
    env = CartDoublePendulum()
    lying = fully_observed(jnp.array([0.0, 1.56, 0.0, 0.0, 5.0, 0.0]), jnp.zeros(()))
    assert jitted(env, "step")(lying, jnp.zeros(1)).terminated
    first = jitted(env, "reset")(jax.random.key(0))
    assert not jitted(env, "step")(first, jnp.zeros(1)).terminated
    over = fully_observed(jnp.asarray(twisted()).at[11].set(-0.5), jnp.zeros(()))
    assert jitted(QuadcopterSE3(), "step")(over, jnp.zeros(4)).terminated
