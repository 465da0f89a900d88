"""The humanoid against Gymnasium's Humanoid-v5: state, observation, reward, termination."""

from dataclasses import replace

import gymnasium
import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import jitted

from hybrid_rl.envs.humanoid import Humanoid

FULL = Humanoid("native", "full")


@pytest.fixture(scope="module")
def theirs():
    env = gymnasium.make("Humanoid-v5")
    yield env.unwrapped
    env.close()


def _at(qpos, qvel):
    """The state of ours at qpos, qvel."""
    data = jitted(FULL._body, "reset")(jnp.asarray(qpos), jnp.asarray(qvel))
    return jitted(FULL, "reset")(jax.random.key(0)).replace(data=data)


def _complete(theirs):
    """(obs [348], x of the centre of mass, contact cost) of Gymnasium's present state.

    Its own are of the last stage of the integrator.
    """
    model, data = theirs.model, mujoco.MjData(theirs.model)
    mujoco.mj_copyData(data, model, theirs.data)
    mujoco.mj_forward(model, data)
    mujoco.mj_rnePostConstraint(model, data)
    parts = (data.qpos[2:], data.qvel, data.cinert[1:], data.cvel[1:])
    parts += (data.qfrc_actuator[6:], data.cfrc_ext[1:])
    cost = min(5e-7 * (data.cfrc_ext**2).sum(), 10.0)
    return np.concatenate([np.ravel(part) for part in parts]), data.subtree_com[0, 0], cost


@pytest.mark.parametrize("physics", ["native", "mjx"], ids="humanoid-{}".format)
def test_a_decision_is_that_of_gymnasium(theirs, physics):
    """Random decisions until a fall, each from Gymnasium's state.

    Measured over 156 decisions: the state 1e-5 with MuJoCo C, 1e-4 with MJX, 2e-4 with Warp; of
    the other entries contact forces, of up to 1,000, 0.01.
    """
    rng, step = np.random.default_rng(0), jitted(replace(FULL, physics=physics), "step")
    touching, lag = 0, []
    for seed in range(3):
        theirs.reset(seed=seed)
        terminated = False
        while not terminated:
            state, before = _at(theirs.data.qpos, theirs.data.qvel), _complete(theirs)[1]
            action = rng.uniform(-1, 1, 17).astype(np.float32)
            obs, reward, terminated, _, info = theirs.step(0.4 * action)
            after, (full, x, cost) = step(state, action), _complete(theirs)
            np.testing.assert_allclose(after.obs[:45], obs[:45], atol=1e-3)
            np.testing.assert_allclose(after.obs[45:270], full[45:270], atol=1e-3)
            np.testing.assert_allclose(after.obs[270:], full[270:], atol=0.1)
            kept = info["reward_survive"] + info["reward_ctrl"]
            expected = kept + 1.25 * (x - before) / 0.015 - cost
            np.testing.assert_allclose(after.reward, expected, atol=1e-3)
            assert bool(after.terminated) == terminated == bool(FULL.ended(after.obs))
            touching += theirs.data.ncon > 0
            lag.append(abs(float(after.reward) - reward))
    assert touching > 5
    assert np.mean(lag) < 0.02  # measured: 0.003


@pytest.mark.parametrize(("z", "ends"), [(1.01, False), (0.99, True), (1.99, False), (2.01, True)])
def test_it_is_healthy_where_that_of_gymnasium_is(theirs, z, ends):
    """It lies in the air, face down."""
    qpos = theirs.init_qpos.copy()
    qpos[2:7] = z, 0.5**0.5, 0, 0.5**0.5, 0
    theirs.set_state(qpos, np.zeros(23))
    after = jitted(FULL, "step")(_at(qpos, np.zeros(23)), jnp.zeros(17))
    assert theirs.step(np.zeros(17))[2] == ends == bool(after.terminated) == FULL.ended(after.obs)


def test_the_contact_cost_is_at_most_ten(theirs):
    """It lands at 20 m/s."""
    qpos, qvel = theirs.init_qpos.copy(), np.zeros(23)
    qvel[2] = -20.0
    theirs.set_state(qpos, qvel)
    after = jitted(FULL, "step")(_at(qpos, qvel), jnp.zeros(17))
    _, reward, _, _, info = theirs.step(np.zeros(17))
    assert info["reward_contact"] == -10.0
    np.testing.assert_allclose(after.reward, reward, atol=0.1)
