"""Properties of every environment in every implementation."""

from dataclasses import replace
from pathlib import Path

import jax
import mujoco
import numpy as np
import pytest
from worlds import (
    ANALYTIC,
    ARMS,
    BROKEN,
    DECISIONS,
    EULER,
    IMPLEMENTATIONS,
    OTHER,
    SIMULATED,
    STATE,
    TASKS,
    TOUCHING,
    jitted,
    make,
    rollout,
    task_of,
)

from hybrid_rl.envs.mujoco import mjcf, scenery
from hybrid_rl.settings.groups import options

pytestmark = pytest.mark.xdist_group("worlds")  # both read `rollout`

CASES = [
    *((t, i) for t in SIMULATED for i in IMPLEMENTATIONS),
    *((t, "analytic") for t in ANALYTIC),
]


FROM_OTHERS = {"gymnasium", "playground", "robot", "online"}  # tests of their own
OWN_TEST = {"sawyer_probe"}  # test_sawyer_probe.py
PAGE = Path(__file__).resolve().parents[2] / "docs" / "tasks.md"


def test_every_task_is_tested_here_and_has_its_row_on_the_page():
    tasks = set(options("task")) - FROM_OTHERS
    assert tasks == TASKS.keys() | OWN_TEST
    table = PAGE.read_text(encoding="utf-8").partition("|---|---|---|\n")[2].partition("\n\n")[0]
    assert tasks == {
        name for row in table.splitlines() for name in row.split("|")[1].split("`")[1::2]
    }


@pytest.fixture(params=CASES, ids="-".join)
def env(request):
    return make(*request.param)


def test_shapes_and_types(env):
    path = rollout(env)
    lead = (2, 2, DECISIONS)
    assert path.obs.shape == (*lead, env.spec.obs)
    assert path.obs.dtype == path.reward.dtype == np.float32
    assert path.reward.shape == path.terminated.shape == path.truncated.shape == lead
    assert path.terminated.dtype == path.truncated.dtype == bool


def test_finite_and_never_truncated(env):
    path = rollout(env)
    for leaf in jax.tree.leaves(path):
        assert np.isfinite(leaf[TOUCHING]).all()
    assert not path.truncated.any()


@pytest.mark.parametrize("task", ["ant", "humanoid", "quadcopter", *ARMS, "sawyer_torque"])
def test_finite_for_long(task):
    """Random decisions beyond the end of episodes."""
    env = TASKS[task](physics="native")

    def one(state, key):
        action = jax.random.uniform(key, (4, env.spec.act), minval=-1, maxval=1)
        state = jax.vmap(env.step)(state, action)
        return state, (state.obs, state.reward)

    key, *keys = jax.random.split(jax.random.key(0), 5)
    state = jax.jit(jax.vmap(env.reset))(jax.numpy.stack(keys))
    _, path = jax.jit(lambda s: jax.lax.scan(one, s, jax.random.split(key, 200)))(state)
    assert all(np.isfinite(leaf).all() for leaf in path)


def test_it_moves(env):
    obs = np.asarray(rollout(env).obs[TOUCHING])
    assert (np.abs(obs[-1] - obs[0]) > 1e-3).any()


def test_same_start_same_path(env):
    path = rollout(env)
    for leaf in jax.tree.leaves(path):
        np.testing.assert_array_equal(leaf[TOUCHING], leaf[OTHER])


def test_nan_propagates_within_its_lane_only(env):
    path = rollout(env)
    obs, reward = np.asarray(path.obs), np.asarray(path.reward)
    assert np.isfinite(obs[BROKEN][:5]).all()
    late = 5 + (task_of(env) in EULER)
    assert np.isnan(obs[BROKEN][late:, : STATE.get(task_of(env))]).all()
    assert np.isnan(reward[BROKEN][5:]).all()
    assert np.isfinite(obs[OTHER]).all()


def test_equal_by_value(env):
    again = replace(env)
    assert env == again
    assert hash(env) == hash(again)


def test_pose_has_the_size_of_the_scene(env):
    model = mjcf.load(scenery.scene_of(env))
    pose = jax.eval_shape(lambda key: env.pose(env.reset(key)), jax.random.key(0))
    assert pose.shape == (model.nq,)
    assert model.camera("track").id >= 0


POINTS = {
    "quadcopter": lambda data: [data.body("quadcopter").xpos],
    "sawyer_push": lambda data: [data.site("tip").xpos, data.body("cube").xpos],
    "panda_stack": lambda data: [data.site("tool").xpos, data.body("block").xpos],
}


def placed(task):
    """States of eight decisions, and where MuJoCo has their points [8, n, 3]."""
    env = make(task, "native")
    states = [jax.tree.map(lambda a, t=t: a[(*OTHER, t)], rollout(env)) for t in range(8)]
    model = mjcf.load(scenery.scene_of(env))
    data, points = mujoco.MjData(model), []
    for state in states:
        data.qpos[:] = env.pose(state)
        mujoco.mj_kinematics(model, data)
        points.append(np.array(POINTS[task](data)))
    return env, states[0], np.stack([state.obs for state in states]), np.array(points)


@pytest.mark.parametrize("task", POINTS)
def test_points_of_observations_are_where_mujoco_has_them(task):
    """From a state and the observations after it."""
    env, first, obs, want = placed(task)
    near = 2e-3 if task == "sawyer_push" else 1e-5  # the height of its rod is not observed
    np.testing.assert_allclose(env.points(first, obs), want, atol=near)
    assert np.ptp(want[:, 0], axis=0).max() > 0.01


def test_points_of_other_observations_of_the_stacked_block():
    env, first, obs, want = placed("panda_stack")
    (tool, block), goal = want.swapaxes(0, 1), np.asarray(env._goal(first.data))
    relative = np.concatenate((block - tool, goal - block, obs[:, 6:7]), 1)
    other = replace(env, observation="relative")
    np.testing.assert_allclose(other.points(first, relative), want, atol=1e-5)
    other = replace(env, observation="stage")
    for closed, left, hand in ((1, goal - block, block), (0, block[0] - tool, tool)):
        stage = np.concatenate((left, np.full((8, 1), closed), block[:, 2:]), 1)
        np.testing.assert_allclose(other.points(first, stage)[:, 0], hand, atol=1e-5)


@pytest.mark.parametrize("task", TASKS)
def test_resets_differ_by_key_and_repeat(task):
    env = make(task, "native")
    first, again, other = (jitted(env, "reset")(jax.random.key(k)).obs for k in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert (np.asarray(first) != np.asarray(other)).any()


@pytest.mark.parametrize("task", SIMULATED)
def test_unknown_physics_is_named(task):
    with pytest.raises(ValueError, match=r"physics=bullet.*native, mjx, warp"):
        make(task, "bullet")


@pytest.mark.parametrize("task", ["halfcheetah", "hopper", "walker2d", "cartpole"])
def test_unknown_reward_is_named(task):
    with pytest.raises(ValueError, match=r"reward=fame: choose one of \w+, \w+"):
        TASKS[task](reward="fame")


@pytest.mark.parametrize("task", ["halfcheetah", "hopper", "walker2d", "cartpole"])
def test_warp_without_a_gpu_raises(task):
    with pytest.raises(ValueError, match=r"physics=warp: must have an NVIDIA GPU"):
        make(task, "warp")
