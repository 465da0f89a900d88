"""A model whose state remembers an episode."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from flax import linen as nn
from toys import begun

from hybrid_rl.core import history
from hybrid_rl.learners.model import ModelLearner
from hybrid_rl.models.ensemble import Ensemble
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.models.recurrent import Recurrent
from hybrid_rl.rewards.network import RewardNetwork
from hybrid_rl.types import Batch, Params, Spec

D, M, H, K = 2, 1, 5, 4
SPEC = Spec(obs=D, act=M, dt=0.1)
MODEL = Recurrent(Ensemble(Gaussian((8,), state_noise=True), 2), history=K, memory=H)
KEY = jax.random.key(0)
close = partial(np.testing.assert_allclose, rtol=1e-4, atol=1e-5)


@pytest.fixture(scope="module")
def lived():
    """Observations [T, o], actions [T, m] of one episode and the histories of K seen in it."""
    rng = np.random.default_rng(0)
    obs, u = rng.normal(size=(8, D)).cumsum(0), rng.uniform(-1, 1, (8, M))
    obs, u = jnp.asarray(obs, jnp.float32), jnp.asarray(u, jnp.float32)
    s = [history.first(obs[0], history.seen(SPEC, K).obs)]
    for action, after in zip(u, obs[1:], strict=False):
        s.append(history.shifted(s[-1], action, after, SPEC.dt))
    return obs, u, jnp.stack(s)


@pytest.fixture(scope="module")
def params(lived):
    """Parameters with statistics of the episode."""
    s = lived[2]
    return MODEL.observe(begun(MODEL, history.seen(SPEC, K)), s[:-1], s[1:])


def test_the_memory_is_a_gru_over_the_last_decisions(lived, params):
    """Flax' GRU, of o, v = (o - o_before) / dt, both normalised, and the action before; h = 0."""
    obs, u, s = lived
    cells = {name: cell["params"]["Dense_0"] for name, cell in params["weights"]["cell"].items()}
    parts = jax.tree.map(lambda leaf: jnp.split(leaf, 3, -1), cells, is_leaf=None)
    weights = {}
    for i, gate in enumerate("rzn"):
        for name, of in (("i", "row"), ("h", "h")):
            weights[name + gate] = {key: parts[of][key][i] for key in ("kernel", "bias")}
        if gate != "n":
            weights["i" + gate]["bias"] += weights["h" + gate].pop("bias")
    h, t = jnp.zeros(H), 6
    for i in range(t - K + 2, t + 1):
        moving = jnp.concatenate((obs[i], (obs[i] - obs[i - 1]) / SPEC.dt))
        state = params["state"]
        moving = (moving - state.mean[: 2 * D]) / state.scale[: 2 * D]
        row = jnp.concatenate((moving, u[i - 1]))
        h = nn.GRUCell(H).apply({"params": weights}, h, row)[0]
    x = MODEL.lift(params, s[t])
    close(x[: 2 * D], s[t][: 2 * D])
    close(x[2 * D :], h)


def test_a_predicted_decision_is_remembered_as_a_real_one(lived, params):
    """The memory after a step is that of a history with the predicted observation, one longer."""
    _, u, s = lived
    x = MODEL.lift(params, s[5])
    longer = Recurrent(MODEL.model, history=K + 1, memory=H)
    noise, draw = jnp.ones((1, x.size)), jax.jit(MODEL.draw)
    mean, disagreement, each = MODEL.predictions(params, x, u[5])
    drawn = draw(params, x[None], u[5][None], noise, KEY)[0]
    close(mean, MODEL.step(params, x, u[5]))
    assert disagreement.size == MODEL.disagreement(params, x, u[5]).size == D
    for after in (mean, *each, drawn):
        rows = jnp.concatenate((after[:D], (after[:D] - s[5][:D]) / SPEC.dt, u[5], s[5][D:]))
        close(after, longer.lift(params, rows))
    assert not np.allclose(drawn[:D], mean[:D])


def test_model_and_reward_teach_the_memory(lived):
    """Each moves the weights of the cell by itself, in the direction of its own gradient."""
    obs, u, s = lived
    spec = history.seen(SPEC, K)
    ones = jnp.ones(7)
    batch = Batch(s[:-1], u[:-1], obs[1:, 0] * 3, 0 * ones, 0 * ones, s[1:])
    both = jax.tree.map(lambda leaf: jnp.concatenate((leaf, leaf)), batch)  # of two members

    def moved(reward, factor=1.0):
        learner = ModelLearner(MODEL, reward, batch_size=7, learning_rate=1e-3)
        state = learner.init(KEY, spec)
        given = both._replace(reward=factor * both.reward)
        after, metrics = jax.jit(learner.update)(state, Params(), given, KEY)
        cell = jax.tree.map(
            jnp.subtract, after.model["weights"]["cell"], state.model["weights"]["cell"]
        )
        return jax.tree.leaves(cell), metrics

    alone, with_reward = moved(None)[0], moved(RewardNetwork((8,)))[0]
    assert all(np.abs(leaf).max() > 1e-4 for leaf in alone)
    assert any(not np.allclose(a, b) for a, b in zip(alone, with_reward, strict=True))


def test_it_needs_a_history():
    with pytest.raises(ValueError, match=r"history.*2 or more; give episode.history=16"):
        Recurrent(Gaussian(), history=1)
