"""What Sawyer's pushing observes, against MuJoCo C and turned scenes."""

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import jitted

from hybrid_rl.envs.experts.push import PushController
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.sawyer_push import ASSET, EXTRA, HEIGHT, HOME, TIP, SawyerPush
from hybrid_rl.types import Params

ALL = SawyerPush("native", reward="code", extra=tuple(EXTRA))
TARGET, COMMAND = np.array([0.6, -0.1]), np.array([0.06, -0.09])


def scene(turn=0.0, velocity=(0.0, 0.0), spin=0.0, reach=(0.05, 0.02), target=TARGET):
    """A state with the block at `reach` from the rod, turned, and in motion."""
    tip = TIP.constant_pose(HOME)[0][:2]
    upright = [np.cos(turn / 2), 0, 0, np.sin(turn / 2)]
    qpos = np.concatenate([HOME, tip + np.asarray(reach), [HEIGHT], upright])
    qvel = np.concatenate([np.zeros(7), velocity, [0, 0, 0, spin]])
    state = jitted(ALL, "reset")(jax.random.key(0))
    data = state.data.replace(qpos=jnp.float32(qpos), qvel=jnp.float32(qvel))
    info = {**state.info, "target": jnp.float32(target), "velocity": jnp.float32(COMMAND)}
    return jitted(ALL, "_state")(data, jnp.zeros(2), info)


def test_all_groups_are_those_of_mujoco():
    """Positions, velocities and the turn of the block, read from MuJoCo C's own data."""
    state = scene(turn=0.7, velocity=(0.09, -0.03), spin=2.0)
    model = mjcf.load(ASSET)
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = state.data.qpos, state.data.qvel
    mujoco.mj_forward(model, data)
    tip, cube, moving = data.site("tip").xpos[:2], data.body("cube"), np.zeros(6)
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, cube.id, moving, 0)
    along = cube.xmat.reshape(3, 3)[:2, 0] @ np.array([1, 1j])  # the block's x axis
    expected = {
        "positions": 10 * np.concatenate([cube.xpos[:2] - tip, cube.xpos[:2] - TARGET]),
        "command": COMMAND / 0.15,
        "turn": [(along**4).real, (along**4).imag],
        "motion": [*moving[3:5] / 0.15, moving[2] / 4],
        "tip": (tip - [0.55, 0.0]) / [0.2, 0.3],
    }
    np.testing.assert_allclose(state.obs, np.concatenate(list(expected.values())), atol=1e-4)
    assert ALL.spec.obs == 13


def test_groups_are_chosen_by_name():
    env = SawyerPush("native", extra=("tip", "command"))
    assert env.extra == ("command", "tip")
    state = jitted(env, "reset")(jax.random.key(0))
    assert state.obs.shape == (env.spec.obs,) == (8,)
    with pytest.raises(ValueError, match=r"extra=.*: choose one of command, turn, motion, tip"):
        SawyerPush("native", extra=("speed",))


def test_reward_and_end_follow_from_observations():
    env = SawyerPush("native", reward="code")
    states = jax.jit(jax.vmap(env.reset))(jax.random.split(jax.random.key(1), 20))
    u = jax.random.uniform(jax.random.key(2), (20, 2), minval=-1)
    after = jax.jit(jax.vmap(env.step))(states, u)
    known = jax.jit(jax.vmap(env.reward_of))(states.obs, u, after.obs)
    np.testing.assert_allclose(known, after.reward, rtol=1e-4)
    near = jnp.array([[1.0, 1.0, 0.3, -0.41], [1.0, 1.0, 0.3, -0.39]])  # 5.08 and 4.92 cm
    assert jax.vmap(env.ended)(near).tolist() == [False, True]


@pytest.mark.parametrize("angle", [np.pi / 2, np.pi, -np.pi / 2])
def test_a_push_is_the_same_along_all_axes(angle):
    """The same push, turned: MuJoCo's next state is the turned one, to a fifth of the motion."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    reach, aim, u = np.array([0.04, 0.006]), np.array([0.05, -0.15]), np.array([1.0, 0.0])
    tip = TIP.constant_pose(HOME)[0][:2]

    def push(state, u):
        still = {**state.info, "velocity": jnp.zeros(2)}
        state = state.replace(info=still)
        for _ in range(5):
            state = jitted(ALL, "step")(state, jnp.float32(u))
        return np.asarray(state.obs)

    straight = push(scene(reach=reach, target=tip + aim), u)
    there = push(scene(turn=angle, reach=turn @ reach, target=tip + turn @ aim), turn @ u)
    pushed = np.linalg.norm(straight[2:4] - 10 * (reach - aim))
    assert pushed > 0.1  # 1 cm
    expected = np.asarray(jax.jit(ALL.turned)(straight, angle))
    np.testing.assert_allclose(there[:4], expected[:4], atol=0.2 * pushed)
    np.testing.assert_allclose(there[4:6], expected[4:6], atol=1e-4)
    turns = [np.arctan2(obs[7], obs[6]) for obs in (there, expected)]
    spun = np.arctan2(straight[7], straight[6])
    assert abs(spun) > 0.4  # 0.1 rad
    assert abs(turns[0] - turns[1]) < 0.2 * abs(spun)


def test_the_heading_is_the_side_that_faces_the_rod():
    """Turned by it, sides are parallel to the axes, and the rod is within 45 degrees of +x."""
    rng = np.random.default_rng(0)
    for turn, rod in rng.uniform(-np.pi, np.pi, (20, 2)):
        obs = np.zeros(13, np.float32)
        obs[:2] = -np.cos(rod), -np.sin(rod)  # from rod to block
        obs[6:8] = np.cos(4 * turn), np.sin(4 * turn)
        heading = float(jax.jit(ALL.heading)(obs))
        assert abs(np.sin(2 * (heading - turn))) < 1e-4  # a multiple of 90 degrees
        assert np.cos(rod - heading) > np.cos(np.pi / 4) - 1e-5


def test_the_expert_acts_on_the_positions_whatever_else_is_observed():
    state = scene(turn=0.4, velocity=(0.05, 0.02))
    key, memory = jax.random.key(0), jnp.array([0.05, -0.02])
    action, *_ = PushController().act(Params(), memory, state.obs, key)
    alone, *_ = PushController().act(Params(), memory, state.obs[:4], key)
    np.testing.assert_array_equal(action, alone)
