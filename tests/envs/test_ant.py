"""The ant against Gymnasium's: contacts with the floor, decisions, termination."""

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


def contacts(model, poses):
    """MuJoCo's contacts of a model in each pose."""
    data = mujoco.MjData(model)
    for data.qpos[:] in poses:
        mujoco.mj_forward(model, data)
        yield data.contact


@pytest.fixture(scope="module")
def poses():
    """200 poses near the floor."""
    qpos = np.random.default_rng(0).uniform(-1, 1, (200, 15))
    qpos[:, 2] = 0.45 + 0.35 * qpos[:, 2]
    return qpos


def test_points_touch_where_the_capsules_of_gymnasium_do(theirs, poses):
    """The same depths at the same points, with the same friction.

    Gymnasium's model has two equal contacts where two capsules meet.
    """
    count, models = 0, (mjcf.load("ant.xml"), theirs.model)
    for pair in zip(*(contacts(model, poses) for model in models), strict=True):
        for contact in pair:
            assert (contact.friction == np.array([1, 1, 0.5, 0.5, 0.5])).all()
            assert np.allclose(contact.includemargin, 0.02)
            assert (contact.dim == 3).all()
        ours, others = (np.column_stack([each.dist, each.pos]) for each in pair)
        difference = np.abs(ours[:, None] - others).max(-1)
        assert (difference.min(0, initial=1.0) < 1e-9).all()
        assert (difference.min(1, initial=1.0) < 1e-9).all()
        count += len(ours)
    assert count > 200


def test_capsules_have_the_contacts_of_gymnasium(theirs, poses):
    """All of them, each with the friction pyramid of Gymnasium's, which lies along the capsule."""
    count, models = 0, (mjcf.load("ant_capsules.xml"), theirs.model)
    for pair in zip(*(contacts(model, poses) for model in models), strict=True):
        rows = [
            np.column_stack([c.dist, c.pos, c.frame, c.friction, c.solref, c.solimp]) for c in pair
        ]
        rows = [x[np.lexsort(x.round(6).T)] for x in rows]
        np.testing.assert_allclose(*rows, atol=1e-9)
        count += len(rows[0])
    assert count > 200


def test_decisions_are_those_of_gymnasium(theirs):
    """Each from Gymnasium's state; most of the last ones are in contact, and one is in the air."""
    ours, rng = Ant("native", "gymnasium", contacts="capsules"), np.random.default_rng(0)
    state, touching = jitted(ours, "reset")(jax.random.key(0)), 0
    for seed in range(5):
        theirs.reset(seed=seed)
        if seed == 4:
            height = np.arange(15) == 2
            theirs.set_state(np.where(height, 10.0, theirs.data.qpos), theirs.data.qvel)
        for _ in range(25):
            qpos, qvel = (jnp.asarray(x) for x in (theirs.data.qpos, theirs.data.qvel))
            action = rng.uniform(-1, 1, 8).astype(np.float32)
            obs, _, terminated, _, info = theirs.step(action)
            after = jitted(ours, "step")(state.replace(data=ours._body.reset(qpos, qvel)), action)
            np.testing.assert_allclose(after.obs, obs, atol=1e-4)  # measured: 5e-6
            assert bool(after.terminated) == terminated == bool(ours.ended(after.obs))
            speed = info["x_position"] / 0.05 - float(qpos[0]) / 0.05
            expected = 1.0 - terminated + speed - 0.5 * (action**2).sum()
            np.testing.assert_allclose(after.reward, expected, atol=1e-3)
            touching += theirs.data.ncon > 0
            if terminated:
                break
    assert terminated
    assert touching > 20


@pytest.mark.parametrize(("height", "falling", "ends"), [(0.75, 0.0, False), (0.7, -12.0, True)])
def test_ant_terminates_below_the_height_limit_of_pybullet(height, falling, ends):
    ant = Ant("native")
    state = jitted(ant, "reset")(jax.random.key(0))
    qpos, qvel = state.data.qpos.at[2].set(height), state.data.qvel.at[2].set(falling)
    after = state.replace(data=state.data.replace(qpos=qpos, qvel=qvel))
    after = jitted(ant, "step")(after, jnp.zeros(8))
    assert bool(after.terminated) == ends == bool(ant.ended(after.obs))
