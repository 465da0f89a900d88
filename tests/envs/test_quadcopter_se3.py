"""The quadcopter on SE(3): its equations by SciPy; attitude, noise, wind, and a lost rotor."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from worlds import flown, follow, many

from hybrid_rl.envs.analytic import quadcopter_se3 as quad
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3

KEY = jax.random.key(5)
PLAIN = QuadcopterSE3(twist=2.0, away=1.0)
MOTION = [0, 1, 2, *range(12, 18)]  # entries of p, v and w


def fly(env, decisions, action):
    """EnvState [decisions + 1] under a constant action, from KEY."""
    return flown(env, KEY, np.tile(action, (decisions, 1)))


def twisted() -> np.ndarray:
    """A state [18] that is turned and moves."""
    with jax.enable_x64(True):
        e = jnp.array([0.1, -0.2, 0.3, 0.2, -0.3, 0.1, 1.0, -0.5, 0.7, 2.0, -1.0, 1.5])
        return np.asarray(QuadcopterSE3().from_local(e))


def integrated(x, seconds, u, wind=0.0, kept=(1, 1, 1, 1)):
    """x [18] after a constant action, by SciPy: Newton and Euler in the world frame."""
    inertia, rotors = np.array(quad.INERTIA), quad.THRUST * u * np.array(kept)

    def rate(_, x):
        R, w = x[3:12].reshape(3, 3), x[15:]
        force = R @ [0, 0, quad.KT * rotors.sum()] / quad.MASS + [wind, 0, -quad.G]
        torque = [
            quad.KT * quad.ARM * (rotors[1] - rotors[3]),
            quad.KT * quad.ARM * (rotors[2] - rotors[0]),
            quad.KM * (rotors @ [1, -1, 1, -1]),
        ]
        turn = R @ np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        spin = (torque - np.cross(w, inertia * w)) / inertia
        return np.concatenate([x[12:15], turn.ravel(), force, spin])

    x = np.array(x, float)
    x[12:15] = x[3:12].reshape(3, 3) @ x[12:15]
    x = solve_ivp(rate, (0, seconds), x, rtol=1e-11, atol=1e-12).y[:, -1]
    x[12:15] = x[3:12].reshape(3, 3).T @ x[12:15]
    return x


def test_it_follows_newton_and_euler() -> None:
    u = np.array([0.6, 0.3, 0.5, 0.2])
    x = follow(QuadcopterSE3(drag=False), twisted(), np.tile(u, (100, 1)))[-1]
    np.testing.assert_allclose(x, integrated(twisted(), 0.5, u), atol=1e-6)


@pytest.mark.parametrize("fault", [{"wind": 3.0}, {"rotor_loss": 0.4}], ids=["wind", "loss"])
def test_faults_begin_at_their_time(fault) -> None:
    env = QuadcopterSE3(drag=False, away=1.0, turn=0.5, fault_time=0.1, **fault)
    calm = QuadcopterSE3(drag=False, away=1.0, turn=0.5)
    u = np.array([0.35, 0.3, 0.25, 0.2], np.float32)
    path = fly(env, 60, u)
    np.testing.assert_allclose(path.data[:21], fly(calm, 20, u).data, atol=1e-6)
    kept = (1 - fault.get("rotor_loss", 0.0), 1, 1, 1)
    end = integrated(path.data[20], 0.2, u, fault.get("wind", 0.0), kept)
    np.testing.assert_allclose(path.data[60], end, atol=2e-5)


def test_rotations_stay_orthogonal() -> None:
    R = follow(QuadcopterSE3(), twisted(), np.full((1200, 4), 0.2))[-1, 3:12].reshape(3, 3)
    np.testing.assert_allclose(R.T @ R, np.eye(3), atol=1e-9)


def test_the_start_is_turned_within_the_angles() -> None:
    """Euler angles as SciPy extracts them; position and twist are those of an upright start."""
    keys = jax.random.split(KEY, 500)
    obs = np.asarray(many(QuadcopterSE3(twist=2.0, away=1.0, turn=0.5), "reset")(keys).obs)
    upright = np.asarray(many(PLAIN, "reset")(keys).obs)
    np.testing.assert_array_equal(obs[:, MOTION], upright[:, MOTION])
    angles = Rotation.from_matrix(obs[:, 3:12].reshape(-1, 3, 3)).as_euler("ZYX")
    assert (np.abs(angles) < 0.5 + 1e-5).all()
    np.testing.assert_allclose(angles.std(axis=0), 0.5 / np.sqrt(3), rtol=0.1)
    assert np.abs(np.corrcoef(angles.T) - np.eye(3)).max() < 0.2


def test_noise_is_on_the_observation_alone() -> None:
    """Its deviation is the given one; states, rewards and metrics are those without noise."""
    std = (0.0,) * 12 + (0.1,) * 3 + (0.5,) * 3
    noisy = QuadcopterSE3(twist=2.0, away=1.0, sensor_noise=std)
    first, path = (fly(env, 100, np.full(4, 0.2)) for env in (PLAIN, noisy))
    np.testing.assert_array_equal(path.data, first.data)
    np.testing.assert_array_equal(path.reward, first.reward)
    np.testing.assert_array_equal(path.metrics["twist"], first.metrics["twist"])
    np.testing.assert_allclose(path.metrics["twist"], (path.data[:, 12:] ** 2).sum(1), rtol=1e-6)
    noise = path.obs - path.data
    np.testing.assert_array_equal(noise[:, :12], 0)
    np.testing.assert_allclose(noise[:, 12:15].std(), 0.1, rtol=0.15)  # of 300
    np.testing.assert_allclose(noise[:, 15:].std(), 0.5, rtol=0.15)


def test_upside_down_ends_the_episode_only_if_it_should() -> None:
    action = np.array([0.0, 0.8, 0.0, -0.8])  # a roll
    tumbling = QuadcopterSE3(twist=2.0, away=1.0, terminate=False)
    path, after = fly(PLAIN, 150, action), fly(tumbling, 150, action)
    assert path.terminated.any()
    np.testing.assert_array_equal(path.terminated, path.data[:, 11] < 0)
    np.testing.assert_array_equal(path.data, after.data)
    assert not after.terminated.any()
