"""Options of the quadcopter on SE(3): random attitude, sensor noise, wind, a lost rotor."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from worlds import jitted

from hybrid_rl.envs.analytic import quadcopter_se3 as quad
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3

KEY = jax.random.key(5)
PLAIN = QuadcopterSE3(twist=2.0, away=1.0)
START = [  # of QuadcopterSE3(twist=2, away=1) at KEY, before it had other options
    *(-0.83237338, -0.54157352, -0.77530575),
    *(-0.13448048, 1.68352413, 0.94324064, -1.61967421, 1.65795851, 0.71091700),
]
MOTION = [0, 1, 2, *range(12, 18)]  # entries of p, v and w


def fly(env, decisions, action):
    """EnvState [decisions + 1] under a constant action, from KEY."""
    state = jitted(env, "reset")(KEY)
    path = [state]
    for _ in range(decisions):
        path.append(jitted(env, "step")(path[-1], action))
    return jax.tree.map(lambda *leaves: np.stack(leaves), *path)


def test_options_that_are_off_change_nothing() -> None:
    """The start is that of the version without them, and the memory is empty."""
    off = QuadcopterSE3(twist=2.0, away=1.0, terminate=False, fault_time=0.01)
    path, same = fly(PLAIN, 5, jnp.full(4, 0.2)), fly(off, 5, jnp.full(4, 0.2))
    np.testing.assert_allclose(path.obs[0, MOTION], START, atol=1e-6)
    np.testing.assert_array_equal(path.obs[0, 3:12], np.eye(3).ravel())
    np.testing.assert_array_equal(path.obs, same.obs)
    assert path.info == same.info == {}


def test_the_start_is_turned_within_the_angles() -> None:
    """Euler angles as SciPy extracts them; position and twist are those of an upright start."""
    env = QuadcopterSE3(twist=2.0, away=1.0, turn=0.5)
    keys = jax.random.split(KEY, 500)
    obs = np.asarray(jax.vmap(env.reset)(keys).obs)
    upright = np.asarray(jax.vmap(PLAIN.reset)(keys).obs)
    np.testing.assert_array_equal(obs[:, MOTION], upright[:, MOTION])
    angles = Rotation.from_matrix(obs[:, 3:12].reshape(-1, 3, 3)).as_euler("ZYX")
    assert (np.abs(angles) < 0.5 + 1e-5).all()
    np.testing.assert_allclose(angles.std(axis=0), 0.5 / np.sqrt(3), rtol=0.1)
    assert np.abs(np.corrcoef(angles.T) - np.eye(3)).max() < 0.2


def test_noise_is_on_the_observation_alone() -> None:
    """Its deviation is the given one; states, rewards and metrics are those without noise."""
    std = (0.0,) * 12 + (0.1,) * 3 + (0.5,) * 3
    noisy = QuadcopterSE3(twist=2.0, away=1.0, sensor_noise=std)
    first, path = fly(PLAIN, 100, jnp.full(4, 0.2)), fly(noisy, 100, jnp.full(4, 0.2))
    np.testing.assert_array_equal(path.data, first.data)
    np.testing.assert_array_equal(path.reward, first.reward)
    np.testing.assert_array_equal(path.metrics["twist"], first.metrics["twist"])
    noise = path.obs - path.data
    np.testing.assert_array_equal(noise[:, :12], 0)
    np.testing.assert_allclose(noise[:, 12:15].std(), 0.1, rtol=0.15)  # of 300
    np.testing.assert_allclose(noise[:, 15:].std(), 0.5, rtol=0.15)


def test_twist_is_the_squared_velocity() -> None:
    path = fly(PLAIN, 3, jnp.zeros(4))
    np.testing.assert_allclose(path.metrics["twist"], np.sum(path.data[:, 12:] ** 2, 1), rtol=1e-6)


def test_upside_down_ends_the_episode_only_if_it_should() -> None:
    action = jnp.array([0.0, 0.8, 0.0, -0.8])  # a roll
    tumbling = QuadcopterSE3(twist=2.0, away=1.0, terminate=False)
    path, after = fly(PLAIN, 150, action), fly(tumbling, 150, action)
    assert path.terminated.any()
    np.testing.assert_array_equal(path.terminated, path.data[:, 11] < 0)
    np.testing.assert_array_equal(path.data, after.data)
    assert not after.terminated.any()


@pytest.mark.parametrize("fault", [{"wind": 3.0}, {"rotor_loss": 0.4}], ids=["wind", "loss"])
def test_faults_against_an_accurate_integration(fault) -> None:
    """Nothing before `fault_time`; then Newton and Euler in the world frame, by SciPy."""
    env = QuadcopterSE3(drag=False, away=1.0, turn=0.5, fault_time=0.1, **fault)
    calm = QuadcopterSE3(drag=False, away=1.0, turn=0.5)
    u = np.array([0.35, 0.3, 0.25, 0.2], np.float32)
    path, undisturbed = fly(env, 60, jnp.asarray(u)), fly(calm, 20, jnp.asarray(u))
    np.testing.assert_allclose(path.data[:21], undisturbed.data, atol=1e-6)
    kept = np.array([1 - fault.get("rotor_loss", 0.0), 1, 1, 1])
    inertia, rotors = np.array(quad.INERTIA), quad.THRUST * u * kept

    def rate(_, x):
        R, w = x[3:12].reshape(3, 3), x[15:]
        force = R @ [0, 0, quad.KT * rotors.sum()] / quad.MASS
        torque = [
            quad.KT * quad.ARM * (rotors[1] - rotors[3]),
            quad.KT * quad.ARM * (rotors[2] - rotors[0]),
            quad.KM * (rotors @ [1, -1, 1, -1]),
        ]
        spin = (torque - np.cross(w, inertia * w)) / inertia
        turned = R @ np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        total = np.add(force, [fault.get("wind", 0.0), 0, -quad.G])
        return np.concatenate([x[12:15], turned.ravel(), total, spin])

    def in_the_world(x):
        return np.concatenate([x[:12], x[3:12].reshape(3, 3) @ x[12:15], x[15:]])

    end = solve_ivp(rate, (0, 0.2), in_the_world(path.data[20]), rtol=1e-9, atol=1e-10).y[:, -1]
    np.testing.assert_allclose(in_the_world(path.data[60]), end, atol=2e-5)


@pytest.mark.parametrize(
    ("field", "line"),
    [
        ({"turn": -1.0}, "turn=-1.0: must be 0 or more"),
        ({"rotor_loss": 1.5}, r"rotor_loss=1.5: must lie in \[0, 1\]"),
        ({"sensor_noise": (0.1, 0.2)}, "sensor_noise=.*: must be 1 or 18 numbers"),
        ({"sensor_noise": (-0.1,)}, "sensor_noise=.*: must be 0 or more"),
    ],
)
def test_bad_options_are_named(field, line) -> None:
    with pytest.raises(ValueError, match=line):
        QuadcopterSE3(**field)
