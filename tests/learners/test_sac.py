"""Soft actor-critic on problems with known values."""

from dataclasses import replace
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.core.actor_critic import ActorCriticState
from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.learners.sac import SAC
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.types import Batch, Params, Spec

pytestmark = pytest.mark.turns(3)

SPEC = Spec(obs=1, act=1, dt=1.0)
B = 64


def learner(**fields: Any) -> SAC:
    """A small learner with high rates."""
    rates: dict[str, Any] = dict.fromkeys(
        ("policy_learning_rate", "critic_learning_rate", "alpha_learning_rate"), 3e-3
    )
    return SAC(
        TanhGaussian(hidden=(32,)), EnsembleQ(hidden=(32, 32)), **(rates | {"tau": 0.05} | fields)
    )


def train(sac: SAC, draw: Any, steps: int) -> ActorCriticState:
    """The state after `steps` updates on batches that `draw` makes."""

    def one(state: ActorCriticState, key: Array) -> tuple[ActorCriticState, None]:
        drawing, updating = jax.random.split(key)
        return sac.update(state, Params(), draw(drawing), updating)[0], None

    keys = jax.random.split(jax.random.key(1), steps)
    return jax.jit(lambda s: jax.lax.scan(one, s, keys)[0])(sac.init(jax.random.key(0), SPEC))


def batch(key: Array, terminated: float, truncated: float, of_action: bool) -> Batch:
    """Uniform actions in one state; reward 1, or -(u - 0.5)^2."""
    u = jax.random.uniform(key, (B, 1), minval=-1, maxval=1)
    reward = -((u[:, 0] - 0.5) ** 2) if of_action else jnp.ones(B)
    obs, one = jnp.zeros((B, 1)), jnp.ones(B)
    return Batch(obs, u, reward, terminated * one, truncated * one, obs, u)


def value(sac: SAC, state: ActorCriticState, u: float = 0.0) -> float:
    """Q of the smaller critic at the one state."""
    return float(sac.critic.value(state.critic, jnp.zeros(1), jnp.array([u])))


def test_a_terminal_reward_is_its_own_value() -> None:
    """Q = r at terminal transitions."""
    sac = learner()
    state = train(sac, partial(batch, terminated=1.0, truncated=0.0, of_action=False), 1500)
    assert value(sac, state) == pytest.approx(1.0, abs=0.05)


def test_a_time_limit_is_bootstrapped_through() -> None:
    """Q = r / (1 - gamma) + entropy bonus, although every transition is truncated."""
    sac = learner(discount=0.5, alpha=1e-6, alpha_learning_rate=1e-9)
    state = train(sac, partial(batch, terminated=0.0, truncated=1.0, of_action=False), 3000)
    assert value(sac, state) == pytest.approx(2.0, abs=0.1)


def test_the_policy_finds_the_best_action() -> None:
    """The mean is at the maximum reward; Q is right there and elsewhere."""
    sac = learner()
    state = train(sac, partial(batch, terminated=1.0, truncated=0.0, of_action=True), 3000)
    mean = float(sac.policy.mean(state.policy, jnp.zeros(1))[0])
    assert mean == pytest.approx(0.5, abs=0.1)
    assert value(sac, state, 0.5) == pytest.approx(0.0, abs=0.1)
    assert value(sac, state, -0.5) == pytest.approx(-1.0, abs=0.15)


def test_the_temperature_meets_its_target() -> None:
    """The entropy converges to its target although the reward favours none.

    The entropy still oscillates by about 0.04 nat; 4,000 samples have an error of 0.01 nat.
    """
    sac = learner(target_entropy=-0.5)
    state = train(sac, partial(batch, terminated=1.0, truncated=0.0, of_action=True), 4000)
    noise = jax.random.normal(jax.random.key(2), (4000, 1))
    log_prob = jax.vmap(lambda e: sac.policy.sample(state.policy, jnp.zeros(1), e)[1])(noise)
    assert -float(log_prob.mean()) == pytest.approx(-0.5, abs=0.1)


@pytest.mark.parametrize("normalise", [False, True])
def test_the_policy_normalises_states_by_the_batches(normalise) -> None:
    """With `normalise` the statistics are those of the batches; gradients do not change them."""
    sac = replace(learner(), policy=TanhGaussian(hidden=(8,), normalise=normalise))

    def far(key: Array) -> Batch:
        drawn = batch(key, 1.0, 0.0, True)
        x = 50 + 200 * jax.random.normal(key, drawn.obs.shape)
        return drawn._replace(obs=x, next_obs=x)

    state = train(sac, far, 200)
    parts = [state.policy]
    for policy in parts:
        assert ("state" in policy) == normalise
        if normalise:
            assert float(policy["state"].mean[0]) == pytest.approx(50, abs=10)
            assert float(policy["state"].std[0]) == pytest.approx(200, rel=0.05)


def test_the_value_is_the_minimum_over_critics() -> None:
    """`value` is the minimum over members."""
    critic = EnsembleQ(hidden=(8,), members=3)
    params = critic.init(jax.random.key(0), SPEC)
    x, u = jnp.ones(1), jnp.ones(1)
    members = critic.all(params, x, u)
    assert members.shape == (3,)
    assert len(set(np.asarray(members).tolist())) == 3
    assert float(critic.value(params, x, u)) == float(members.min())


def test_pessimism_counts_standard_deviations() -> None:
    """Mean - p std against NumPy; of two members with p = 1 it is their minimum."""
    x, u = jnp.array([[0.3], [-2.0]]), jnp.array([[0.5], [-0.1]])
    for members, pessimism in ((3, 0.56), (2, 1.0)):
        critic = EnsembleQ(hidden=(8,), members=members, pessimism=pessimism)
        params = critic.init(jax.random.key(0), SPEC)
        each = np.asarray(critic.all(params, x, u), np.float64)
        wanted = each.mean(0) - pessimism * each.std(0) if members > 2 else each.min(0)
        np.testing.assert_allclose(critic.value(params, x, u), wanted, atol=1e-5)
    with pytest.raises(ValueError, match=r"pessimism=-1"):
        EnsembleQ(pessimism=-1)


def test_scaled_values_begin_at_zero_and_reach_large_returns() -> None:
    """In 100 updates a scaled critic has learned most of a return of 1,000, another one little."""

    def large(key: Array) -> Batch:
        drawn = batch(key, 1.0, 0.0, False)
        return drawn._replace(reward=1000 * drawn.reward)

    found = []
    for scale in (True, False):
        critic = EnsembleQ(hidden=(32, 32), scale=scale, normalise=scale)
        sac = replace(learner(discount=0.0), critic=critic)
        if scale:
            assert value(sac, sac.init(jax.random.key(0), SPEC)) == 0
        found.append(value(sac, train(sac, large, 100)))
    assert 800 < found[0] < 1001
    assert abs(found[1]) < 200


def test_the_target_has_the_critic_s_statistics() -> None:
    """After one update both are in units of the same return and see states in the same units."""
    critic = EnsembleQ(hidden=(8,), scale=True, normalise=True)
    sac = replace(learner(discount=0.9), critic=critic)
    first = sac.init(jax.random.key(0), SPEC)

    def at_seven(key: Array) -> Batch:
        return batch(key, 0.0, 0.0, False)._replace(obs=jnp.full((B, 1), 7.0))

    state = train(sac, at_seven, 1)
    assert float(state.target["value"].magnitude[0]) == pytest.approx(10)
    assert float(state.target["state"].mean[0]) == pytest.approx(7)
    for old, new, target in zip(
        *(jax.tree.leaves(each["weights"]) for each in (first.critic, state.critic, state.target)),
        strict=True,
    ):
        np.testing.assert_allclose(target, 0.95 * old + 0.05 * new, rtol=1e-5, atol=1e-8)
