"""The quadcopter against that on SE(3), whose equations are the thesis'."""

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import along, follow, jitted, placed

from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.envs.quadcopter import Quadcopter

MASS, GRAVITY = 0.6, 9.81


@pytest.mark.parametrize("damping", [False, True])
def test_it_follows_the_equations_of_the_thesis(damping):
    env = Quadcopter("native", damping=damping)
    state = jitted(env, "reset")(jax.random.key(3))
    actions = np.random.default_rng(0).uniform(-1, 1, (200, 4)).astype(np.float32)
    first = np.concatenate([np.zeros(3), np.eye(3).ravel(), state.obs[6:], state.obs[3:6]])
    x = follow(QuadcopterSE3(damping), first, actions)[1:]
    expected = np.concatenate([-GRAVITY * x[:, 9:12], x[:, 15:], x[:, 12:15]], 1)
    path = along(env, state, actions)
    np.testing.assert_allclose(path.obs, expected, atol=2e-3)
    assert np.abs(expected).max() > 5


def test_reward():
    env = Quadcopter("native", task="track")
    state = jitted(env, "reset")(jax.random.key(0))
    after = jitted(env, "step")(state, jnp.array([0.5, -0.5, 1.0, 0.0]))
    g, w, v, away = np.asarray(after.obs, float).reshape(4, 3)
    u = np.array([3.0, -3.0, 6.0, 0.0]) - 2.4525
    cost = ((g - [0, 0, -GRAVITY]) ** 2).sum() + (w**2).sum() + 5 * (v**2).sum()
    cost += 5 * (away**2).sum() + (u**2).sum()
    np.testing.assert_allclose(after.reward, -0.005 * cost, rtol=1e-4)
    hover = jitted(Quadcopter("native"), "step")(state, jnp.array([0.5, -0.5, 1.0, 0.0]))
    np.testing.assert_array_equal(hover.obs, after.obs[:9])
    nearer = after.reward + 0.005 * 5 * (away**2).sum()
    np.testing.assert_allclose(hover.reward, nearer, rtol=1e-4, atol=1e-5)


def test_wind_is_a_force_on_the_body():
    """As MuJoCo C has it: m a along x, in a fall with moving rotors."""
    env, actions = Quadcopter("native", wind=3.0), np.random.default_rng(1).uniform(-1, 1, (100, 4))
    state = jitted(env, "reset")(jax.random.key(2))
    model, data = placed("quadcopter.xml", state.data.qpos, state.data.qvel)
    data.xfrc_applied[1, 0] = 3.0 * MASS
    for action in actions:
        data.ctrl[:4] = 6 * action
        mujoco.mj_step(model, data)
    last = jax.tree.map(lambda a: a[-1], along(env, state, actions)).data
    np.testing.assert_allclose(last.qvel, data.qvel, atol=1e-4)
    np.testing.assert_allclose(last.qpos[:3], data.qpos[:3], atol=5e-3)  # half a step ahead
    assert data.qvel[0] > 1.0


def test_the_target_moves():
    """Observations are relative to it, and tell where the body is."""
    env = Quadcopter("native", task="track", target_speed=1.0)
    state = jitted(env, "reset")(jax.random.key(0))
    target, speed = state.info["target"], state.info["target_velocity"]
    assert (np.abs(target) <= 2.0).all()
    assert (np.abs(speed) > 0).all()
    np.testing.assert_allclose(env.pose(state)[7:], target)
    relative = state.data.qvel[:3] - speed
    np.testing.assert_allclose(state.obs[6:9], relative, atol=1e-6)  # level at the start
    path = along(env, state, np.random.default_rng(0).uniform(-1, 1, (40, 4)))
    np.testing.assert_allclose(path.info["target"][-1], target + 0.2 * speed, atol=1e-5)
    points = env.points(state, jnp.concatenate((state.obs[None], path.obs)))[:, 0]
    np.testing.assert_allclose(points[0], state.data.qpos[:3])
    np.testing.assert_allclose(points[1:], path.data.qpos[:, :3], atol=1e-4)


WEAK = {"mass": 1.2, "payload": 0.1, "motors": np.array([0.8, 1.0, 1.2, 0.6])}


@pytest.mark.parametrize(
    "given",
    [{"task": "hover"}, {"task": "track"}, WEAK],
    ids=["hover", "track", "weak"],
)
def test_at_equilibrium_it_hovers(given):
    """A weak motor at more control, so that there is no moment; the reward is 0 in any body."""
    env = Quadcopter("native", **{"start_speed": 0.0, "target_distance": 0.0} | given)
    factor = (0.72 + 0.1) / 0.6 / WEAK["motors"] if given is WEAK else 1.0
    np.testing.assert_allclose(env.hovering, 2.4525 * factor)
    obs, action = env.equilibrium()
    path = along(env, jitted(env, "reset")(jax.random.key(0)), np.tile(action, (200, 1)))
    np.testing.assert_allclose(path.obs[0], obs, atol=1e-6)
    np.testing.assert_allclose(path.obs[-1], obs, atol=1e-4)
    np.testing.assert_allclose(path.reward, 0.0, atol=1e-6)
    np.testing.assert_array_equal(path.metrics["success"], 1.0)
    assert not path.terminated.any()
