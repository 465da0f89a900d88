"""The model learner on worlds whose dynamics and rewards are known."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.learners.model import ModelLearner
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.objectives.learned_reward import LearnedReward
from hybrid_rl.types import Batch, Params, Path, Spec

SPEC = Spec(obs=2, act=1, dt=0.1)
SCALE = jnp.array([1.0, 100.0])  # units that differ, as positions and velocities do


def follow(x: Array, u: Array) -> Array:
    """Known dynamics in awkward units."""
    y = x / SCALE
    return SCALE * (y + 0.1 * jnp.stack([y[1], jnp.sin(y[0]) + u[0]]))


def pay(x: Array, u: Array) -> Array:
    """Known reward."""
    return jnp.cos(x[0]) - 0.1 * u[0] ** 2


def draw(key: Array, size: int = 128) -> Batch:
    """Random states and actions; the next action is the same."""
    of_x, of_u = jax.random.split(key)
    x = SCALE[None] * jax.random.normal(of_x, (size, 2))
    u = jax.random.uniform(of_u, (size, 1), minval=-1, maxval=1)
    no = jnp.zeros(size)
    return Batch(x, u, jax.vmap(pay)(x, u), no, no, jax.vmap(follow)(x, u), u)


def trained(learner: ModelLearner, steps: int, batch: object = draw) -> Params:
    """What is known after `steps` updates."""

    def one(state: object, key: Array) -> tuple:
        return learner.update(state, Params(), batch(key), key)[0], None

    keys = jax.random.split(jax.random.key(1), steps)
    first = learner.init(jax.random.key(0), SPEC)
    return Params(**learner.params(jax.jit(lambda s: jax.lax.scan(one, s, keys)[0])(first)))


def test_model_and_reward_are_learned() -> None:
    """One-step error far below the change itself, in every unit."""
    model, reward = Gaussian(hidden=(64,), activation="silu"), LearnedReward(hidden=(64,))
    params = trained(ModelLearner(model, reward), 4000)
    test = draw(jax.random.key(9), 1000)
    ahead = jax.vmap(model.step, (None, 0, 0))(params.model, test.obs, test.action)
    error = jnp.abs(ahead - test.next_obs).mean(0)
    change = jnp.abs(test.next_obs - test.obs).mean(0)
    assert (np.asarray(error) < 0.1 * np.asarray(change)).all()
    got = jax.vmap(reward.reward, (None, 0, 0))(params.reward, test.obs, test.action)
    assert float(jnp.abs(got - test.reward).mean()) < 0.05


def test_reward_discount_learns_a_value() -> None:
    """With reward 1 for ever the utility is 1 / (1 - c); where episodes end it is 1."""

    def endless(key: Array, terminated: float = 0.0) -> Batch:
        batch = draw(key)
        one = jnp.ones(128)
        return batch._replace(reward=one, terminated=terminated * one, next_obs=batch.obs)

    reward = LearnedReward(hidden=(32,))
    learner = ModelLearner(Gaussian(hidden=(8,)), reward, reward_discount=0.8)
    at = (jnp.zeros(2), jnp.zeros(1))
    assert float(reward.reward(trained(learner, 4000, endless).reward, *at)) == pytest.approx(
        5, abs=0.4
    )
    ended = trained(learner, 2000, lambda key: endless(key, 1.0)).reward
    assert float(reward.reward(ended, *at)) == pytest.approx(1, abs=0.1)


def test_reward_to_go_is_the_sum_of_what_follows() -> None:
    """S_t = r_t + discount S_{t+1}, with nothing after the end."""
    reward = LearnedReward(hidden=(8,), discount=0.9)
    params = Params(reward=reward.init(jax.random.key(0), SPEC))
    path = Path(jax.random.normal(jax.random.key(1), (5, 2)), jnp.ones((4, 1)))
    rates = [float(reward.reward(params.reward, path.x[t], path.u[t])) for t in range(4)]
    want = [sum(0.9 ** (i - t) * rates[i] for i in range(t, 4)) for t in range(5)]
    np.testing.assert_allclose(reward.reward_to_go(params, path), want, rtol=1e-4, atol=1e-6)


def test_where_episodes_end_is_learned_and_ends_the_return() -> None:
    """Ended where x_0 > 0: nothing is earned after that."""

    def ending(key: Array) -> Batch:
        batch = draw(key)
        return batch._replace(
            reward=jnp.ones(128), terminated=(batch.obs[:, 0] > 0).astype(jnp.float32)
        )

    reward = LearnedReward(hidden=(32,), ends=True)
    params = trained(ModelLearner(Gaussian(hidden=(8,)), reward), 2000, ending)
    still = jnp.zeros(1)
    for x, wanted in ((jnp.array([-1.0, 0.0]), 3), (jnp.array([1.0, 0.0]), 1)):
        path = Path(jnp.tile(x, (4, 1)), jnp.tile(still, (3, 1)))
        got = reward.reward_to_go(params, path)
        assert float(got[0]) == pytest.approx(wanted, abs=0.1)
        assert float(got[-1]) == 0
