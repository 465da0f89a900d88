"""A model whose state remembers an episode."""

from dataclasses import replace
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import begun

from hybrid_rl.core import history
from hybrid_rl.learners.model import ModelLearner
from hybrid_rl.models.ensemble import Ensemble
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.models.recurrent import Recurrent
from hybrid_rl.networks import MLP
from hybrid_rl.rewards.network import RewardNetwork
from hybrid_rl.types import Batch, Params, Spec

D, M, H, K = 2, 1, 5, 4
SPEC = Spec(obs=D, act=M, dt=0.1)
MODEL = Recurrent(Ensemble(Gaussian((8,), state_noise=True), 2), history=K, memory=H, hidden=(16,))
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


def measured(params, obs, before, u):
    """K and y [h] of observation `obs` [o] after action u [m] at the one `before`."""
    moving = jnp.concatenate((obs, (obs - before) / SPEC.dt))
    moving = (moving - params["state"].mean[: 2 * D]) / params["state"].scale[: 2 * D]
    out = MLP((16,), 2 * H, "silu").apply(params["weights"]["filter"], jnp.concatenate((moving, u)))
    return jax.nn.sigmoid(out[:H]), jnp.tanh(out[H:])


def test_the_memory_is_a_filter_over_the_last_decisions(lived, params):
    """As of all decisions before, by the share of the weights that the last ones have."""
    obs, u, s = lived
    sums, weights, t = jnp.zeros(H), jnp.zeros(H), 6
    for i in range(t - K + 2, t + 1):
        gain, y = measured(params, obs[i], obs[i - 1], u[i - 1])
        sums, weights = sums + gain * (y - sums), weights + gain * (1 - weights)
    x = MODEL.lift(params, s[t])
    close(x[: 2 * D], s[t][: 2 * D])
    close(x[2 * D :], sums / weights)


def test_predicted_decisions_go_on_from_there(lived, params):
    obs, u, s = lived
    x = MODEL.lift(params, s[5])
    mean, disagreement, each = MODEL.predictions(params, x, u[5])
    drawn = jax.jit(MODEL.draw)(params, x[None], u[5][None], jnp.ones((1, x.size)), KEY)[0]
    close(mean, MODEL.step(params, x, u[5]))
    assert disagreement.size == MODEL.disagreement(params, x, u[5]).size == D
    for after in (mean, *each, drawn):
        gain, y = measured(params, after[:D], obs[5], u[5])
        close(after[D : 2 * D], (after[:D] - obs[5]) / SPEC.dt)
        close(after[2 * D :], x[2 * D :] + gain * (y - x[2 * D :]))
    assert not np.allclose(drawn[:D], mean[:D])


@pytest.mark.parametrize("bias", [-200.0, -3.0, 200.0])
def test_a_memory_of_equal_decisions_is_what_each_tells(bias, params):
    """Whatever the gain: a long history is no other than a short one."""
    filter_ = jax.tree.map(jnp.zeros_like, params["weights"]["filter"])
    filter_["params"]["Dense_1"]["bias"] = jnp.full(2 * H, 0.7).at[:H].set(bias)
    params = {**params, "weights": {**params["weights"], "filter": filter_}}
    for length in (2, 40):
        longer = replace(MODEL, history=length)
        size = history.seen(SPEC, length).obs
        h = longer.lift(params, jnp.arange(size) / size)[2 * D :]
        close(h, np.full(H, np.tanh(0.7)))


def test_model_and_reward_teach_the_memory(lived):
    """Other rewards move the filter elsewhere, from the same weights and decisions."""
    obs, u, s = lived
    none = jnp.zeros(7)
    batch = Batch(s[:-1], u[:-1], obs[1:, 0], none, none, s[1:])
    both = jax.tree.map(lambda leaf: jnp.concatenate((leaf, leaf)), batch)  # of two members

    def moved(learner, sign):
        state = learner.init(KEY, history.seen(SPEC, K))
        given = both._replace(reward=sign * both.reward)
        after = jax.jit(learner.update)(state, Params(), given, KEY)[0]
        nets = (each.model["weights"]["filter"] for each in (after, state))
        return np.concatenate(
            [leaf.ravel() for leaf in jax.tree.leaves(jax.tree.map(jnp.subtract, *nets))]
        )

    alone, paid = (ModelLearner(MODEL, r, batch_size=7) for r in (None, RewardNetwork((8,))))
    assert np.abs(moved(alone, 1)).max() > 1e-4
    np.testing.assert_array_equal(moved(alone, 1), moved(alone, -1))
    assert np.abs(moved(paid, 1) - moved(paid, -1)).max() > 1e-4


def test_statistics_leave_the_memory_as_it_is(params):
    """h is in [-1, 1] already: mean 0, scale 1."""
    mean, scale = params["state"].mean[2 * D :], params["state"].scale[2 * D :]
    np.testing.assert_array_equal((mean, scale), ([0.0] * H, [1.0] * H))


def test_it_needs_a_history():
    with pytest.raises(ValueError, match=r"history.*2 or more; give episode.history=32"):
        Recurrent(Gaussian(), history=1)
