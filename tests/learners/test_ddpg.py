"""Deterministic policy gradients on problems with known values."""

from dataclasses import replace
from functools import partial

import jax
import jax.numpy as jnp
import pytest
from jax import Array

from hybrid_rl.core.actor_critic import ActorCriticState
from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.learners.ddpg import DDPG
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.types import Batch, Params, Spec

SPEC = Spec(obs=1, act=1, dt=1.0)
B = 64


def learner(**fields: float) -> DDPG:
    """A small learner with high rates."""
    quick = {"policy_learning_rate": 1e-3, "critic_learning_rate": 3e-3, "tau": 0.05}
    critic = EnsembleQ(hidden=(32, 32), members=1)
    return DDPG(TanhGaussian(hidden=(32,)), critic, **(quick | fields))


def train(ddpg: DDPG, draw: partial, steps: int) -> ActorCriticState:
    """The state after `steps` updates on batches that `draw` makes."""

    def one(state: ActorCriticState, key: Array) -> tuple[ActorCriticState, None]:
        return ddpg.update(state, Params(), draw(key), key)[0], None

    keys = jax.random.split(jax.random.key(1), steps)
    return jax.jit(lambda s: jax.lax.scan(one, s, keys)[0])(ddpg.init(jax.random.key(0), SPEC))


def batch(key: Array, terminated: float, truncated: float, best: float) -> Batch:
    """Uniform actions in one state; reward 1 - (u - best)^2."""
    u = jax.random.uniform(key, (B, 1), minval=-1, maxval=1)
    obs, one = jnp.zeros((B, 1)), jnp.ones(B)
    reward = 1 - (u[:, 0] - best) ** 2
    return Batch(obs, u, reward, terminated * one, truncated * one, obs, u)


def value(ddpg: DDPG, state: ActorCriticState, u: float) -> float:
    """Q at the one state."""
    return float(ddpg.critic.value(state.critic, jnp.zeros(1), jnp.array([u])))


@pytest.mark.parametrize("best", [0.5, -0.3])
def test_the_policy_finds_the_best_action(best) -> None:
    """At terminal transitions Q is the reward, also of other actions."""
    ddpg = learner()
    state = train(ddpg, partial(batch, terminated=1.0, truncated=0.0, best=best), 3000)
    assert float(ddpg.policy.mean(state.policy, jnp.zeros(1))[0]) == pytest.approx(best, abs=0.1)
    assert value(ddpg, state, best) == pytest.approx(1.0, abs=0.1)
    assert value(ddpg, state, best - 0.6) == pytest.approx(0.64, abs=0.15)


def test_a_time_limit_is_bootstrapped_through() -> None:
    """Q of the best action is r / (1 - gamma), although every transition is truncated."""
    ddpg = learner(discount=0.5)
    state = train(ddpg, partial(batch, terminated=0.0, truncated=1.0, best=0.5), 4000)
    assert value(ddpg, state, 0.5) == pytest.approx(2.0, abs=0.15)
    assert value(ddpg, state, -0.5) == pytest.approx(1.0, abs=0.2)


@pytest.mark.parametrize("normalise", [False, True])
def test_the_policy_normalises_states_by_the_batches(normalise) -> None:
    """With `normalise` the statistics are those of the batches; gradients do not change them."""
    ddpg = replace(learner(), policy=TanhGaussian(hidden=(8,), normalise=normalise))

    def far(key: Array) -> Batch:
        drawn = batch(key, 1.0, 0.0, 0.5)
        x = 50 + 200 * jax.random.normal(key, drawn.obs.shape)
        return drawn._replace(obs=x, next_obs=x)

    state = train(ddpg, far, 200)
    parts = [state.policy, state.target_policy]
    for policy in parts:
        assert ("state" in policy) == normalise
        if normalise:
            assert float(policy["state"].mean[0]) == pytest.approx(50, abs=10)
            assert float(policy["state"].std[0]) == pytest.approx(200, rel=0.05)


@pytest.mark.parametrize("change", [{"discount": 1.0}, {"tau": 0.0}, {"policy_learning_rate": 0}])
def test_bad_fields(change) -> None:
    """One line that names the field."""
    with pytest.raises(ValueError, match=next(iter(change))):
        learner(**change)
