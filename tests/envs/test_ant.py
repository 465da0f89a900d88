"""The ant against Gymnasium's: contacts with the floor, free fall, termination."""

from pathlib import Path

import gymnasium
import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import jitted

from hybrid_rl.envs.ant import Ant
from hybrid_rl.envs.mujoco import mjcf


@pytest.fixture
def theirs():
    """Gymnasium's, with the observation and the reward of its version 4."""
    env = gymnasium.make("Ant-v5", contact_cost_weight=0.0, include_cfrc_ext_in_observation=False)
    yield env.unwrapped
    env.close()


def test_points_touch_where_the_capsules_of_gymnasium_do():
    """The same depths at the same points, with the same friction.

    Gymnasium's model has two equal contacts where two capsules meet.
    """
    rng = np.random.default_rng(0)
    file = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets" / "ant.xml"
    models = (mjcf.load("ant.xml"), mujoco.MjModel.from_xml_path(str(file)))
    datas = [mujoco.MjData(model) for model in models]
    count = 0
    for _ in range(200):
        qpos = rng.uniform(-1, 1, 15)
        qpos[2] = rng.uniform(0.1, 0.8)
        for model, data in zip(models, datas, strict=True):
            data.qpos[:] = qpos
            mujoco.mj_forward(model, data)
            assert (data.contact.friction == np.array([1, 1, 0.5, 0.5, 0.5])).all()
            assert np.allclose(data.contact.includemargin, 0.02)
            assert (data.contact.dim == 3).all()
        ours, theirs = (np.column_stack([d.contact.dist, d.contact.pos]) for d in datas)
        difference = np.abs(ours[:, None] - theirs).max(-1)
        assert (difference.min(0, initial=1.0) < 1e-9).all()
        assert (difference.min(1, initial=1.0) < 1e-9).all()
        count += len(ours)
    assert count > 200


def test_ant_is_that_of_gymnasium(theirs):
    """States in free fall; reward and termination also near the floor."""
    theirs.reset(seed=3)
    ours, rng = Ant("native", "gymnasium"), np.random.default_rng(0)
    step = jitted(ours, "step")
    for height, decisions, ends in ((10.0, 20, True), (0.75, 1, False)):
        qpos = theirs.data.qpos.copy()
        qpos[2] = height
        theirs.set_state(qpos, theirs.data.qvel)
        data = ours._body.reset(jnp.asarray(qpos), jnp.asarray(theirs.data.qvel))
        state = ours.reset(jax.random.key(0)).replace(data=data)
        for _ in range(decisions):
            action = rng.uniform(-1, 1, 8).astype(np.float32)
            obs, reward, terminated, _, info = theirs.step(action)
            before, state = state.data.qpos[0], step(state, action)
            speed = (state.data.qpos[0] - before) / 0.05  # Gymnasium's lags by one physics step
            expected = reward - info["reward_forward"] + speed
            np.testing.assert_allclose(state.reward, expected, atol=1e-4)
            assert bool(state.terminated) == terminated == ends
            if height > 1:
                np.testing.assert_allclose(state.obs, obs, atol=1e-4)


def test_capsules_touch_as_those_of_gymnasium(theirs):
    """Random decisions, each from Gymnasium's state; most of the last ones are in contact."""
    ours, rng = Ant("native", "gymnasium", contacts="capsules"), np.random.default_rng(0)
    state, step = ours.reset(jax.random.key(0)), jitted(ours, "step")
    touching = 0
    for seed in range(4):
        theirs.reset(seed=seed)
        for _ in range(25):
            qpos, qvel = (jnp.asarray(x) for x in (theirs.data.qpos, theirs.data.qvel))
            action = rng.uniform(-1, 1, 8).astype(np.float32)
            obs, _, terminated, _, info = theirs.step(action)
            after = step(state.replace(data=ours._body.reset(qpos, qvel)), action)
            np.testing.assert_allclose(after.obs, obs, atol=1e-4)  # measured: 5e-6
            assert bool(after.terminated) == terminated == bool(ours.ended(after.obs))
            speed = info["x_position"] / 0.05 - float(qpos[0]) / 0.05
            expected = 1.0 - terminated + speed - 0.5 * (action**2).sum()
            np.testing.assert_allclose(after.reward, expected, atol=1e-3)
            touching += theirs.data.ncon > 0
            if terminated:
                break
    assert touching > 20


def test_capsules_have_the_contacts_of_gymnasium(theirs):
    """All of them, each with the friction pyramid of Gymnasium's, which lies along the capsule."""
    rng, model = np.random.default_rng(0), mjcf.load("ant_capsules.xml")
    data, count = mujoco.MjData(model), 0
    for _ in range(100):
        qpos = rng.uniform(-1, 1, 15)
        qpos[2] = rng.uniform(0.1, 0.8)
        theirs.set_state(qpos, np.zeros(14))
        data.qpos[:] = qpos
        mujoco.mj_forward(model, data)
        rows = [
            np.column_stack([c.dist, c.pos, c.frame, c.friction, c.solref, c.solimp])
            for c in (data.contact, theirs.data.contact)
        ]
        rows = [x[np.lexsort(x.round(6).T)] for x in rows]
        np.testing.assert_allclose(*rows, atol=1e-9)
        count += len(rows[0])
    assert count > 200


@pytest.mark.parametrize(("height", "falling", "ends"), [(0.75, 0.0, False), (0.7, -12.0, True)])
def test_ant_terminates_below_the_height_limit(height, falling, ends):
    ant = Ant("native")
    state = jitted(ant, "reset")(jax.random.key(0))
    qpos, qvel = state.data.qpos.at[2].set(height), state.data.qvel.at[2].set(falling)
    data = state.data.replace(qpos=qpos, qvel=qvel)
    after = jitted(ant, "step")(state.replace(data=data), jnp.zeros(8))
    assert bool(after.terminated) == ends == bool(ant.ended(after.obs))
    angle, limits = after.data.qpos[7:], ant._body.model.jnt_range[1:]
    middle, half = limits.mean(1), (limits[:, 1] - limits[:, 0]) / 2
    at_limit = (np.abs((angle - middle) / half) > 0.99).sum()
    expected = (-1.0 if ends else 1.0) + after.metrics["speed"] - 0.1 * at_limit
    np.testing.assert_allclose(after.reward, expected, atol=1e-4)
