"""Sawyer's pushing: commands, rewards, starts, an expert, and what it observes."""

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import IMPLEMENTATIONS, jitted, make, many, placed, play

from hybrid_rl.envs.experts.push import PushController
from hybrid_rl.envs.mujoco.kinematics import rotate_towards
from hybrid_rl.envs.sawyer_push import ASSET, EXTRA, HEIGHT, HOME, TIP, SawyerPush

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
    model, data = placed(ASSET, state.data.qpos, state.data.qvel)
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


def test_reward_and_end_follow_from_observations():
    env = SawyerPush("native", reward="code")
    states = many(env, "reset")(jax.random.split(jax.random.key(1), 20))
    u = jax.random.uniform(jax.random.key(2), (20, 2), minval=-1)
    after = many(env, "step")(states, u)
    known = many(env, "reward_of")(states.obs, u, after.obs)
    np.testing.assert_allclose(known, after.reward, rtol=1e-4)
    near = jnp.array([[1.0, 1.0, 0.3, -0.41], [1.0, 1.0, 0.3, -0.39]])  # 5.08 and 4.92 cm
    assert jax.vmap(env.ended)(near).tolist() == [False, True]


def test_the_heading_is_the_side_that_faces_the_rod():
    """Turned by it, sides are parallel to the axes, and the rod is within 45 degrees of +x."""
    rng = np.random.default_rng(0)
    for turn, rod in rng.uniform(-np.pi, np.pi, (20, 2)):
        obs = np.zeros(13, np.float32)
        obs[:2] = -np.cos(rod), -np.sin(rod)  # from rod to block
        obs[6:8] = np.cos(4 * turn), np.sin(4 * turn)
        heading = float(jitted(ALL, "heading")(obs))
        assert abs(np.sin(2 * (heading - turn))) < 1e-4  # a multiple of 90 degrees
        assert np.cos(rod - heading) > np.cos(np.pi / 4) - 1e-5


def test_the_rod_follows_its_velocity_command():
    """2 s along y at 0.1 m/s, at constant height and orientation."""
    env = SawyerPush("native", smoothing=0.0)
    state = jitted(env, "reset")(jax.random.key(0))
    aside = state.data.qpos.at[7:9].set(jnp.array([0.7, 0.4]))
    state = state.replace(data=state.data.replace(qpos=aside))
    begin, upright = TIP.constant_pose(HOME)
    step = jitted(env, "step")
    for _ in range(20):
        state = step(state, jnp.array([0.0, 0.1 / 0.15]))
    tip, rotation, _ = TIP.pose(state.data.qpos)
    np.testing.assert_allclose(tip - begin, [0.0, 0.2, 0.0], atol=0.01)
    assert abs(tip[2] - begin[2]) < 1e-3
    assert jnp.abs(rotate_towards(rotation, jnp.asarray(upright), 1.0)).max() < np.radians(0.5)
    for _ in range(40):
        state = step(state, jnp.array([1.0, 1.0]))
    tip = TIP.pose(state.data.qpos)[0]
    np.testing.assert_allclose(tip[:2], env.high, atol=0.02)


def _sawyer(tip_to_block, block_to_target, action, **fields):
    """The state after one decision with the block and the target at these offsets."""
    env = SawyerPush("native", **fields)
    state = jitted(env, "reset")(jax.random.key(0))
    block = TIP.pose(state.data.qpos)[0][:2] + jnp.asarray(tip_to_block)
    qpos = state.data.qpos.at[7:9].set(block)
    info = {**state.info, "target": block + jnp.asarray(block_to_target)}
    return jitted(env, "step")(state.replace(data=state.data.replace(qpos=qpos), info=info), action)


def test_push_reward():
    state = _sawyer((0.3, 0.4), (0.0, 0.1), jnp.zeros(2))
    np.testing.assert_allclose(state.reward, -5 * 0.1 - 10 * 0.5, atol=2e-3)
    np.testing.assert_allclose(state.obs, [3.0, 4.0, 0.0, -1.0], atol=2e-3)
    moving = _sawyer((0.3, 0.4), (0.0, 0.1), jnp.array([0.0, 1.0]))
    near, far = (np.linalg.norm(moving.obs[i : i + 2]) for i in (0, 2))
    np.testing.assert_allclose(moving.reward, -0.5 * far - near - 0.01, atol=1e-4)
    assert not state.terminated
    assert _sawyer((0.3, 0.4), (0.0, 0.049), jnp.zeros(2)).terminated
    continued = _sawyer((0.3, 0.4), (0.0, 0.049), jnp.zeros(2), terminate=False)
    assert continued.metrics["success"] == 1.0
    assert not continued.terminated


def test_push_starts_keep_their_distances():
    env = SawyerPush("native")
    states = many(env, "reset")(jax.random.split(jax.random.key(0), 500))
    block, target = np.asarray(states.data.qpos[:, 7:9]), np.asarray(states.info["target"])
    tip = TIP.constant_pose(HOME)[0][:2]
    assert (np.linalg.norm(block - tip, axis=1) > 0.06).all()
    assert (np.linalg.norm(block - env.block, axis=1) <= 0.08 + 1e-6).all()
    assert (np.linalg.norm(block - target, axis=1) > 0.12).all()
    assert (target >= env.target_low).all()
    assert (target <= env.target_high).all()
    assert (target.std(0) > [0.04, 0.08]).all()
    np.testing.assert_allclose(states.data.qpos[:, 9], HEIGHT)
    assert not states.terminated.any()


@pytest.mark.parametrize("implementation", IMPLEMENTATIONS, ids="sawyer_push-{}".format)
def test_the_expert_pushes_the_block_to_the_target(implementation):
    path = play(make("sawyer_push", implementation), PushController(), 100)[1]
    assert path.metrics["success"].any(1).all()
    height = path.data.qpos[..., 9]
    assert jnp.abs(height - HEIGHT).max() < 2e-3  # the block neither tips nor jumps
    assert jnp.abs(path.data.qvel).max() < 5.0
