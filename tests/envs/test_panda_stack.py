"""Panda's stacking: rewards, its hand, what it observes, and an expert that succeeds."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from worlds import IMPLEMENTATIONS, jitted, make, play

from hybrid_rl.envs.experts.stack import StackController
from hybrid_rl.envs.panda_stack import TOOL, PandaStack
from hybrid_rl.types import Params


def _panda(env, block, closed, fingers):
    """The state with the block at this offset from the hand [3], and the hand's position [3]."""
    state = jitted(env, "reset")(jax.random.key(0))
    tool = TOOL.pose(state.data.qpos)[0]
    held = jnp.concatenate([jnp.full(2, fingers), tool + jnp.asarray(block)])
    data = state.data.replace(qpos=state.data.qpos.at[7:12].set(held))
    info = {**state.info, "closed": jnp.float32(closed)}
    return jitted(env, "_state")(data, jnp.zeros(4), info), tool


def test_stack_reward():
    env = PandaStack("native")
    free, tool = _panda(env, (0.3, 0.0, -0.4), 0.0, 0.04)
    np.testing.assert_allclose(free.reward, -0.5, rtol=1e-5)
    held, _ = _panda(env, (0.0, 0.005, 0.01), 1.0, 0.0255)
    goal = np.array([0.45, 0.12, 0.075])
    np.testing.assert_allclose(held.reward, -1.25 * np.linalg.norm(tool - goal), rtol=1e-5)
    assert held.metrics["grasped"] == 1.0
    joined, _ = _panda(PandaStack("native", reward="joined"), (0.3, 0.0, -0.4), 0.0, 0.04)
    left = np.linalg.norm(np.asarray(tool) + np.array([0.3, 0.0, -0.4]) - goal)
    np.testing.assert_allclose(joined.reward, -0.5 - 1.25 * left, rtol=1e-5)
    for block, closed, fingers in [
        ((0.0, 0.005, 0.01), 0.0, 0.0255),  # commanded to open
        ((0.0, 0.005, 0.01), 1.0, 0.03),  # not closed
        ((0.0, 0.0, -0.03), 1.0, 0.025),  # next to the block
    ]:
        assert _panda(env, block, closed, fingers)[0].metrics["grasped"] == 0.0


def test_stack_success():
    env = PandaStack("native")
    _, tool = _panda(env, (0.0, 0.0, 0.0), 0.0, 0.04)
    there = np.array([0.45, 0.12, 0.075]) - np.asarray(tool)
    assert _panda(env, there, 0.0, 0.04)[0].terminated
    assert not _panda(PandaStack("native", terminate=False), there, 0.0, 0.04)[0].terminated
    for shift, closed in [((0.03, 0, 0), 0.0), ((0, 0, 0.015), 0.0), ((0, 0, 0), 1.0)]:
        assert _panda(env, there + shift, closed, 0.04)[0].metrics["success"] == 0.0


@pytest.mark.parametrize(
    ("tool_to_block", "closed", "then"),
    [
        ((0.0, 0.0, 0.009), 0.0, 1.0),  # within reach
        ((0.0, 0.0, 0.011), 0.0, 0.0),
        ((0.0, 0.0, 0.02), 1.0, 1.0),  # kept
        ((0.0, 0.0, 0.03), 1.0, 0.0),  # lost
    ],
)
def test_the_hand_closes_automatically(tool_to_block, closed, then):
    env = PandaStack("native")
    state, _ = _panda(env, tool_to_block, closed, 0.04)
    assert env._closes(state, jnp.zeros(3)) == then


def test_the_hand_opens_automatically():
    env = PandaStack("native")
    _, tool = _panda(env, (0.0, 0.0, 0.0), 1.0, 0.025)
    there = np.array([0.45, 0.12, 0.075]) - np.asarray(tool)  # from hand to target
    state, _ = _panda(env, there, 1.0, 0.025)
    at = state.data.qpos[9:12]
    for offset, closed in [((0.0, 0.0, 0.009), False), ((0.011, 0.0, 0.0), True)]:
        obs = state.obs.at[:3].set(at + jnp.array(offset)).at[3:6].set(at + jnp.array(offset))
        assert env._closes(state.replace(obs=obs), jnp.zeros(3)) == closed


def test_the_observation_of_a_stage_leads_the_expert_in_the_same_way():
    """Over the states of its own episode, with observations that NumPy makes."""
    env = PandaStack("native", observation="stage")
    plain, other = (StackController(observation=o) for o in ("thesis", "stage"))
    thesis = np.asarray(play(PandaStack("native"), StackController(), 100)[1].obs)
    thesis = thesis.reshape(-1, thesis.shape[-1])
    tool, block, closed = thesis[:, :3], thesis[:, 3:6], thesis[:, 6:7]
    goal = np.array([0.45, 0.12, 0.075], np.float32)
    obs = np.hstack([np.where(closed, goal - block, block - tool), closed, block[:, 2:]])
    expected, got = (
        jax.jit(jax.vmap(lambda o, one=one: one.act(Params(), (), o, jax.random.key(0))[0]))(o)
        for one, o in ((plain, thesis), (other, obs))
    )
    np.testing.assert_allclose(got, expected, atol=1e-4)
    for shift, closes in ((0.002, True), (0.011, False)):
        state, tool = _panda(env, (0.004, 0.003, shift), 0.0, 0.04)
        block = np.asarray(tool) + np.array([0.004, 0.003, shift])
        np.testing.assert_allclose(state.obs, [0.004, 0.003, shift, 0.0, block[2]], atol=1e-6)
        assert env._closes(state, jnp.zeros(3)) == closes


@pytest.mark.parametrize("implementation", IMPLEMENTATIONS, ids="panda_stack-{}".format)
def test_the_expert_stacks_the_block(implementation):
    path = play(make("panda_stack", implementation), StackController(grip="action"), 120)[1]
    assert path.metrics["success"].any(1).all()
    np.testing.assert_array_equal(path.metrics["success"][:, -1], 1.0)
    assert (path.metrics["grasped"].sum(1) > 20).all()
    moved = path.data.qpos[..., 16:19] - jnp.array([0.45, 0.12, 0.025])[None, None]
    assert jnp.abs(moved).max() < 5e-3  # the base does not move
