"""Hopper, walker and half-cheetah: what they observe, when they end, and PyBullet's reward."""

import gymnasium
import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import TASKS, jitted, make

from hybrid_rl.envs.halfcheetah import LEGS, _kneels
from hybrid_rl.envs.locomotion import pybullet_reward
from hybrid_rl.envs.mujoco.physics import Physics


def after(env, qpos, qvel=None):
    """The state one decision without action after the pose qpos."""
    qvel = jnp.zeros(len(qpos)) if qvel is None else qvel
    state = jitted(env, "reset")(jax.random.key(0))
    data = env._body.reset(jnp.asarray(qpos, jnp.float32), qvel)
    return jitted(env, "step")(state.replace(data=data), jnp.zeros(env.spec.act))


@pytest.mark.parametrize("task", ["hopper", "walker2d"])
def test_observed_velocities_are_clipped_as_asked(task):
    size, seen = make(task).spec.obs + 1 >> 1, {}
    for limit in (10.0, 4.0, None):
        env = make(task, velocity_limit=limit)
        state = after(env, [0, 1.25, *[0] * (size - 2)], 12.0 * jnp.ones(size))
        seen[limit], qvel = state.obs[-size:], state.data.qvel
    assert jnp.abs(qvel).max() > 11.0
    np.testing.assert_array_equal(seen[None], qvel)
    for limit in (10.0, 4.0):
        np.testing.assert_array_equal(seen[limit], jnp.clip(qvel, -limit, limit))


@pytest.mark.parametrize(
    ("z", "pitch", "ends"),
    [(0.78, 0, True), (0.84, 0.98, False), (0.84, -1.02, True), (1.98, 0, False), (2.02, 0, True)],
)
def test_walker_is_healthy_where_that_of_gymnasium_is(z, pitch, ends):
    theirs, ours = gymnasium.make("Walker2d-v5").unwrapped, make("walker2d")
    theirs.reset(seed=1)
    qpos = np.array([0, z, pitch, 0, -1, 0, 0, -1, 0])
    theirs.set_state(qpos, np.zeros(9))
    state, (_, reward, terminated, *_) = after(ours, qpos), theirs.step(np.zeros(6))
    assert bool(state.terminated) == terminated == ends == bool(ours.ended(state.obs))
    np.testing.assert_allclose(state.reward, float(reward), atol=1e-4)


def test_cheetah_kneels_where_mujoco_has_a_contact():
    body = Physics("halfcheetah_contact.xml", "native")
    model, rng = body.model, np.random.default_rng(0)
    data = mujoco.MjData(model)
    qpos = rng.uniform(-0.5, 0.5, (300, 9)).astype(np.float32)
    qpos[:, 1] -= 0.1
    kneels = jax.jit(jax.vmap(lambda q: _kneels(body, body.reset(q, jnp.zeros(9)))))(qpos)
    legs, truth = {model.geom(name).id for name in LEGS}, []
    for data.qpos[:] in qpos:
        mujoco.mj_forward(model, data)
        truth.append(bool(legs & set(data.contact.geom2.tolist())))
    assert 30 < sum(truth) < 270
    np.testing.assert_array_equal(kneels, truth)


def test_reward_of_pybullet():
    """1 + 2 - 2 mean(.5 * .4, 1 * .2) - 0.1 mean(.25, 1) - 0.1 of one joint at its limit."""
    limits = jnp.array([[-1.0, 1.0], [0.0, 2.0]])
    u, q, v = jnp.array([0.5, -1.0]), jnp.array([0.0, 2.0]), jnp.array([4.0, 2.0])
    reward = pybullet_reward(jnp.array(True), jnp.float32(2.0), u, q, v, limits)
    np.testing.assert_allclose(reward, 1 + 2 - 2 * 0.2 - 0.0625 - 0.1, rtol=1e-6)


def test_rewards_of_pybullet_end_all_but_the_cheetah():
    cheetah = make("halfcheetah", reward="pybullet")
    stand, fall = after(cheetah, np.zeros(9)), after(cheetah, [0, 0, 3, 0, 0, 0, 0, 0, 0])
    assert stand.reward - stand.metrics["speed"] > 0.5
    assert fall.reward - fall.metrics["speed"] < -0.9
    assert not fall.terminated
    for task in ("hopper", "walker2d"):
        env = TASKS[task]("native", "pybullet")
        first = jitted(env, "reset")(jax.random.key(0)).data.qpos
        states = {pitch: after(env, first.at[2].set(pitch)) for pitch in (0.0, 0.9, 1.1)}
        assert [bool(state.terminated) for state in states.values()] == [False, False, True]
        assert states[1.1].reward - states[1.1].metrics["speed"] < -0.9
