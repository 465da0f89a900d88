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


def test_contacts_are_those_of_gymnasium():
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


def test_ant_is_that_of_gymnasium():
    """States in free fall; reward and termination also near the floor."""
    theirs = gymnasium.make(
        "Ant-v5", contact_cost_weight=0.0, include_cfrc_ext_in_observation=False
    ).unwrapped
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
    theirs.close()


@pytest.mark.parametrize(("height", "falling", "ends"), [(0.75, 0.0, False), (0.7, -12.0, True)])
def test_ant_terminates_below_the_height_limit(height, falling, ends):
    ant = Ant("native")
    state = jitted(ant, "reset")(jax.random.key(0))
    qpos, qvel = state.data.qpos.at[2].set(height), state.data.qvel.at[2].set(falling)
    data = state.data.replace(qpos=qpos, qvel=qvel)
    after = jitted(ant, "step")(state.replace(data=data), jnp.zeros(8))
    assert bool(after.terminated) == ends
    angle, limits = after.data.qpos[7:], ant._body.model.jnt_range[1:]
    middle, half = limits.mean(1), (limits[:, 1] - limits[:, 0]) / 2
    at_limit = (np.abs((angle - middle) / half) > 0.99).sum()
    expected = (-1.0 if ends else 1.0) + after.metrics["speed"] - 0.1 * at_limit
    np.testing.assert_allclose(after.reward, expected, atol=1e-4)
