"""The model learner on environments with known dynamics and rewards."""

from collections.abc import Callable
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from toys import begun, learned

from hybrid_rl.learners.model import ModelLearner
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.rewards.network import RewardNetwork
from hybrid_rl.types import Batch, Params, Path, Spec

SPEC = Spec(obs=2, act=1, dt=0.1)
SCALE = jnp.array([1.0, 100.0])  # units that differ, as positions and velocities do


def follow(x: Array, u: Array) -> Array:
    """Known dynamics in units of different scales."""
    y = x / SCALE
    return SCALE * (y + 0.1 * jnp.stack([y[1], jnp.sin(y[0]) + u[0]]))


def pay(x: Array, u: Array) -> Array:
    """Known reward."""
    return jnp.cos(x[0]) - 0.1 * u[0] ** 2


@partial(jax.jit, static_argnums=1)
def draw(key: Array, size: int = 128) -> Batch:
    """Random states and actions; the next action is the same."""
    of_x, of_u = jax.random.split(key)
    x = SCALE[None] * jax.random.normal(of_x, (size, 2))
    u = jax.random.uniform(of_u, (size, 1), minval=-1, maxval=1)
    no = jnp.zeros(size)
    return Batch(x, u, jax.vmap(pay)(x, u), no, no, jax.vmap(follow)(x, u), u)


def trained(learner: ModelLearner, steps: int, batch: Callable = draw) -> Params:
    """The parameters after `steps` updates."""
    return Params(**learner.params(learned(learner, SPEC, batch, steps)[0]))


def predictions(model: Gaussian, params: Params, test: Batch) -> Array:
    """The next states [B, o]."""
    return jax.jit(jax.vmap(model.step, (None, 0, 0)))(params.model, test.obs, test.action)


def outcomes(reward: RewardNetwork, params: Params, test: Batch) -> tuple[Array, Array]:
    """Rewards and logits of the end [B]."""
    outcome = jax.jit(jax.vmap(reward.outcome, (None, 0, 0, 0)))
    return outcome(params, test.obs, test.action, test.next_obs)


def test_reward_discount_learns_a_value() -> None:
    """With a constant reward 1 the utility is 1 / (1 - c); if episodes end it is 1."""

    def endless(key: Array, terminated: float = 0.0) -> Batch:
        batch = draw(key)
        one = jnp.ones(128)
        return batch._replace(reward=one, terminated=terminated * one, next_obs=batch.obs)

    reward = RewardNetwork(hidden=(32,))
    learner = ModelLearner(Gaussian(hidden=(8,)), reward, reward_discount=0.8)
    at = (jnp.zeros(2), jnp.zeros(1), jnp.zeros(2))
    going = trained(learner, 2000, endless).reward
    assert float(reward.outcome(Params(reward=going), *at)[0]) == pytest.approx(5, abs=0.4)
    ended = trained(learner, 1000, lambda key: endless(key, 1.0)).reward
    assert float(reward.outcome(Params(reward=ended), *at)[0]) == pytest.approx(1, abs=0.1)


def test_where_episodes_end_is_learned_and_ends_the_return() -> None:
    """Episodes end where x_0 > 0: no reward follows."""

    def ending(key: Array) -> Batch:
        batch = draw(key)
        ends = (batch.obs[:, 0] > 0).astype(jnp.float32)
        return batch._replace(reward=jnp.ones(128), terminated=ends)

    reward = RewardNetwork(hidden=(32,), ends=True)
    params = trained(ModelLearner(Gaussian(hidden=(8,)), reward), 2000, ending)
    still = jnp.zeros(1)
    for x, wanted in ((jnp.array([-1.0, 0.0]), 3), (jnp.array([1.0, 0.0]), 1)):
        path = Path(jnp.tile(x, (4, 1)), jnp.tile(still, (3, 1)))
        got = PredictedReturn(reward).reward_to_go(params, path)
        assert float(got[0]) == pytest.approx(wanted, abs=0.1)
        assert float(got[-1]) == 0


def noise(x: Array) -> Array:
    """Standard deviation [B, 2] at x [B, 2]: from 0.02 to 0.2."""
    return 0.02 + 0.09 * (1 + x[:, :1]) * jnp.ones(2)[None]


@partial(jax.jit, static_argnums=1)
def draw_noisy(key: Array, size: int = 200) -> Batch:
    """x' = x + (0.5 x_1, u) + noise(x) e, for x and u U(-1, 1)."""
    of_x, of_u, of_e = jax.random.split(key, 3)
    x = jax.random.uniform(of_x, (size, 2), minval=-1)
    u = jax.random.uniform(of_u, (size, 1), minval=-1)
    after = x + jnp.concatenate([0.5 * x[:, 1:], u], 1)
    after += noise(x) * jax.random.normal(of_e, (size, 2))
    no = jnp.zeros(size)
    return Batch(x, u, no, no, no, after, u)


def test_mean_and_standard_deviation_are_learned() -> None:
    """Without a reward; both as functions of the state, in its units."""
    model = Gaussian(hidden=(64,), activation="silu", state_noise=True)
    learner = ModelLearner(model, updates=1)
    state, metrics = learned(learner, SPEC, draw_noisy, 2000)
    assert (learner.owns, list(learner.params(state))) == (("model",), ["model"])
    params, loss = Params(**learner.params(state)), np.asarray(metrics["model/loss"])
    assert loss[-100:].mean() < loss[:100].mean() - 0.5
    test = draw_noisy(jax.random.key(9), 500)
    wanted = test.obs + np.concatenate([0.5 * test.obs[:, 1:], test.action], 1)
    assert np.sqrt(np.mean((predictions(model, params, test) - wanted) ** 2)) < 0.03
    scale = params.model["change"].std
    std = jax.jit(jax.vmap(lambda x: model.std(params.model, x) * scale))(test.obs)
    assert np.mean(np.abs(std / noise(test.obs) - 1)) < 0.15


def test_weight_decay_shrinks_matrices_alone() -> None:
    """Adam's first step is learning_rate sign(gradient); AdamW's takes a share of W more."""
    learner = ModelLearner(Gaussian(hidden=(8,)), RewardNetwork(hidden=(8,)), weight_decay=10.0)
    first = begun(learner, SPEC)
    update = jax.jit(learner.update)
    after = update(first, Params(), draw(jax.random.key(2)), jax.random.key(0))[0]
    for name in ("model", "reward"):
        old, new = (
            jax.tree_util.tree_leaves_with_path(getattr(state, name)["weights"])
            for state in (first, after)
        )
        for (path, w), (_, now) in zip(old, new, strict=True):
            decay = learner.learning_rate * 10 if "kernel" in str(path[-1]) else 0
            step = np.abs(np.asarray(now - (1 - decay) * w)) / learner.learning_rate
            assert (np.minimum(step, np.abs(step - 1)) < 1e-2).all()  # 0 where no unit is active
            assert step.max() > 0.9


def test_a_reward_of_the_next_state_is_learned() -> None:
    """Of x' that the action does not decide: r = x'_0 / 10 and the end at x'_0 > 0 are exact."""

    def jumping(key: Array) -> Batch:
        batch = draw(key)
        after = 10 * jax.random.normal(jax.random.fold_in(key, 1), (128, 2))
        ends = (after[:, 0] > 0).astype(jnp.float32)
        return batch._replace(reward=after[:, 0] / 10, next_obs=after, terminated=ends)

    reward = RewardNetwork(hidden=(32,), activation="silu", ends=True, next_state=True)
    params = trained(ModelLearner(Gaussian(hidden=(8,)), reward), 1000, jumping)
    test = jumping(jax.random.key(9))
    r, end = outcomes(reward, params, test)
    assert np.abs(r - test.reward).mean() < 0.1
    assert ((end > 0) == (test.terminated > 0)).mean() > 0.95
