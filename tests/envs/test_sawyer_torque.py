"""Sawyer under torque control: reference, model, inverse dynamics and controllers."""

from functools import cache

import jax
import mujoco
import numpy as np
import pytest
from scipy.linalg import null_space
from worlds import placed

from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.envs import sawyer_torque
from hybrid_rl.envs.experts.tracking import ComputedTorque, JointPD
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.sawyer_torque import SawyerTorque, asset
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import rollout
from hybrid_rl.types import Params

NEUTRAL = (0, -1.18, 0, 2.18, 0, 0.57, 3.3161)  # [rad], Rethink Robotics' sawyer_robot
DAMPING = (10, 5, 5, 1, 2, 1, 1)  # [N m s/rad], the same
DT = 0.01  # [s]
BLEND = 100  # decisions to the path


def _thesis(t):
    """The path of the thesis [..., 3] [m]."""
    return np.stack([0.8 + 0 * t, 0.1 * np.cos(2 * t), 0.1 * np.sin(4 * t) + 0.4], -1)


def _tip(q):
    """Position of the tip [3] and its Jacobian [3, 7] in MuJoCo C."""
    (model, data), jacobian = placed("sawyer_torque.xml", q), np.zeros((3, 7))
    mujoco.mj_jacSite(model, data, jacobian, None, model.site("tip").id)
    return data.site("tip").xpos, jacobian


def test_the_reference_follows_the_path_of_the_thesis_near_the_neutral_pose():
    table = sawyer_torque.table(2, DT)
    on_path = table[BLEND:-1]
    t = DT * np.arange(len(on_path))
    np.testing.assert_allclose(on_path[:, 14:], _thesis(t), atol=1e-9)
    assert len(on_path) == 629
    for q, point in list(zip(on_path[:, :7], _thesis(t), strict=True))[::50]:
        position, jacobian = _tip(q)
        np.testing.assert_allclose(position, point, atol=1e-9)
        free = null_space(jacobian)  # motions that leave the tip where it is
        np.testing.assert_allclose(free.T @ (np.array(NEUTRAL) - q), 0, atol=1e-9)
    ranges = {0: (-0.33, -0.15), 1: (-1.34, -1.08), 3: (1.55, 1.65)}
    for joint, (low, high) in ranges.items():
        assert low < on_path[:, joint].min() < on_path[:, joint].max() < high


def test_the_rates_of_the_reference_are_its_derivative():
    table = sawyer_torque.table(2, DT)[:-1]
    q, rate = table[:, :7], table[:, 7:14]
    slope = (q[2:] - q[:-2]) / (2 * DT)
    ends = np.abs(np.arange(1, len(q) - 1) - BLEND) < 2  # its third derivative jumps there
    np.testing.assert_allclose(rate[1:-1][~ends], slope[~ends], atol=2e-3)
    assert np.abs(np.diff(rate, axis=0)).max() < 3.2 * DT  # [rad/s^2]
    fine = sawyer_torque.joints(np.array([0.999, 1.0, 1.001]))
    np.testing.assert_allclose(fine[1][1], (fine[0][2] - fine[0][0]) / 2e-3, atol=1e-5)
    np.testing.assert_allclose(fine[2][1], (fine[1][2] - fine[1][0]) / 2e-3, atol=1e-4)
    np.testing.assert_array_equal(table[0, :14], [*NEUTRAL, *np.zeros(7)])


@cache
def _play(kind, payload=0.0, learn=5, decisions=265, **gains):
    """Observations [T, 42] and errors of the tip [T] [m] of a controller, or of no torque."""
    env = SawyerTorque("native", payload=payload, learn=learn)
    acting, key = kind(env, **gains) if kind else ConstantController(), jax.random.key(0)
    path = jax.jit(lambda: rollout(Episode(env), acting, Params(), key, decisions))()
    return np.asarray(path.obs[1:]), np.asarray(path.metrics["tip_error"][1:])


def test_the_reference_of_the_next_decision_comes_true():
    obs, error = _play(None)
    np.testing.assert_array_equal(obs[1:, 14:28], obs[:-1, 28:])
    rows = sawyer_torque.table(2, DT)[:, :14]
    np.testing.assert_allclose(obs[4:, 14:28], rows[: len(obs) - 4], atol=1e-6)
    np.testing.assert_array_equal(obs[:4, 14:28], np.tile(obs[4, 14:28], (4, 1)))
    tips = [np.linalg.norm(_tip(o[:7])[0] - _tip(o[14:21])[0]) for o in obs[::40]]
    np.testing.assert_allclose(error[::40], tips, atol=2e-6)


def test_at_equilibrium_it_rests():
    env = SawyerTorque("native", start_spread=0.0)
    obs, action = env.equilibrium()
    state = jax.jit(env.reset)(jax.random.key(0))
    np.testing.assert_array_equal(state.obs, obs)
    step = jax.jit(env.step)
    for _ in range(5):
        state = step(state, action)
    np.testing.assert_allclose(state.obs, obs, atol=1e-5)


def test_gravity_pulls_the_payload_alone():
    model, data = placed(asset("maker", 1.5), NEUTRAL)
    np.testing.assert_array_equal(model.dof_damping.reshape(7, -1)[:, 0], DAMPING)
    plain = mjcf.load(asset("none"))
    np.testing.assert_array_equal(plain.actuator_gear[:, 0], [80, 80, 40, 40, 9, 9, 9])  # [N m]
    assert not plain.dof_damping.any()
    assert model.body_mass.sum() - plain.body_mass.sum() == pytest.approx(1.5)
    jacobian = np.zeros((3, 7))
    mujoco.mj_jacBodyCom(model, data, jacobian, None, model.body("rod").id)
    pull = data.qfrc_passive - data.qfrc_bias
    np.testing.assert_allclose(pull, jacobian.T @ [0, 0, -9.81 * 1.5], atol=1e-9)
    np.testing.assert_array_equal(model.geom_size, plain.geom_size)


INTEGRAL = {"frequency": 30.0, "integral": 10.0}


@pytest.mark.parametrize(
    ("kind", "fields", "low", "high"),
    [
        (ComputedTorque, {}, 0, 1e-3),  # measured: 0.11 mm
        (JointPD, {}, 2e-3, 15e-3),  # 8 mm
        (ComputedTorque, {"payload": 1.0}, 20e-3, 80e-3),  # 41 mm
        (JointPD, {"payload": 1.0}, 20e-3, 80e-3),  # 44 mm
        (ComputedTorque, {"payload": 1.0, **INTEGRAL}, 0, 6e-3),  # 3.2 mm, within 1.6 s
        (JointPD, {"payload": 1.0, "integral": 10.0}, 0, 15e-3),
    ],
)
def test_controllers_track_the_path(kind, fields, low, high):
    """An unknown payload pulls both from it, and an integral removes most of that."""
    error = _play(kind, **fields)[1][5 + BLEND :]  # of the tip on the first 1.6 s of the path [m]
    assert low < np.sqrt((error**2).mean()) < high
