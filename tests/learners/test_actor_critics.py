"""Actor-critic learners on problems of one state, with known values."""

from dataclasses import replace
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from toys import begun, learned

from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.learners.ddpg import DDPG
from hybrid_rl.learners.sac import SAC
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.types import Batch, Params, Spec

SPEC = Spec(obs=1, act=1, dt=1.0)
B = 64
RATES = dict.fromkeys(("policy_learning_rate", "critic_learning_rate"), 3e-3)


def learner(name: str, **fields: Any) -> Any:
    """A small learner with high rates."""
    fields = {"tau": 0.05, "discount": 0.5, **RATES, **fields}
    if name == "ddpg":
        critic = EnsembleQ(hidden=(32, 32), members=1)
        return DDPG(TanhGaussian(hidden=(32,)), critic, **fields)
    fields = {"alpha_learning_rate": 3e-3, **fields}
    return SAC(TanhGaussian(hidden=(32,)), EnsembleQ(hidden=(32, 32)), **fields)


def batch(key: Array, terminated: Any = 1.0, best: Any = 0.5) -> Batch:
    """Uniform actions in one state; reward 1 - (u - best)^2. Every decision ends an episode."""
    u = jax.random.uniform(key, (B, 1), minval=-1, maxval=1)
    obs, one = jnp.zeros((B, 1)), jnp.ones(B)
    reward = 1 - (u[:, 0] - best) ** 2
    return Batch(obs, u, reward, terminated * one, (1 - terminated) * one, obs, u)


def value(learner: Any, state: Any, u: float) -> float:
    """Q at the one state."""
    return float(learner.critic.value(state.critic, jnp.zeros(1), jnp.array([u])))


@pytest.mark.parametrize("name", ["sac", "ddpg"])
def test_the_values_and_the_best_action_are_found(name: str) -> None:
    """At terminal transitions Q is the reward, also of actions that are not the best.

    A time limit is bootstrapped through: Q of the best action is r / (1 - gamma), although every
    transition is truncated. SAC's entropy pays nothing here.
    """
    made = learner(name, **({"alpha": 1e-6, "alpha_learning_rate": 1e-9} if name == "sac" else {}))
    first = begun(made, SPEC)

    @jax.jit
    @partial(jax.vmap, in_axes=(0, 0))
    def trained(terminated: Array, best: Array) -> tuple:
        def one(state: Any, key: Array) -> tuple:
            drawing, updating = jax.random.split(key)
            drawn = batch(drawing, terminated, best)
            return made.update(state, Params(), drawn, updating)[0], None

        state = jax.lax.scan(one, first, jax.random.split(jax.random.key(1), 3000))[0]
        return state, made.policy.mean(state.policy, jnp.zeros(1))[0]

    states, mean = trained(jnp.array([1.0, 0.0]), jnp.array([-0.3, 0.5]))
    np.testing.assert_allclose(mean, [-0.3, 0.5], atol=0.1)
    ended, going = (jax.tree.map(lambda leaf, i=i: leaf[i], states) for i in range(2))
    assert value(made, ended, -0.3) == pytest.approx(1.0, abs=0.1)
    assert value(made, ended, -0.9) == pytest.approx(0.64, abs=0.15)
    assert value(made, going, 0.5) == pytest.approx(2.0, abs=0.15)
    assert value(made, going, -0.5) == pytest.approx(1.0, abs=0.2)


def test_the_temperature_meets_its_target() -> None:
    """The entropy converges to its target although the reward favours none.

    The entropy still oscillates by about 0.04 nat; 4,000 samples have an error of 0.01 nat.
    """
    sac = learner("sac", target_entropy=-0.5)
    state, _ = learned(sac, SPEC, batch, 4000)
    noise = jax.random.normal(jax.random.key(2), (4000, 1))
    log_prob = jax.vmap(lambda e: sac.policy.sample(state.policy, jnp.zeros(1), e)[1])(noise)
    assert -float(log_prob.mean()) == pytest.approx(-0.5, abs=0.1)
    mean = float(sac.policy.mean(state.policy, jnp.zeros(1))[0])
    assert mean == pytest.approx(0.5, abs=0.1)


def test_scaled_values_begin_at_zero_and_reach_large_returns() -> None:
    """In 100 updates a scaled critic has learned most of a return of 1,000, another one little."""

    def large(key: Array) -> Batch:
        return batch(key)._replace(reward=jnp.full(B, 1000.0))

    found = []
    for scale in (True, False):
        critic = EnsembleQ(hidden=(32, 32), scale=scale, normalise=scale)
        sac = replace(learner("sac", discount=0.0), critic=critic)
        if scale:
            assert value(sac, begun(sac, SPEC), 0.0) == 0
        found.append(value(sac, learned(sac, SPEC, large, 100)[0], 0.0))
    assert 800 < found[0] < 1001
    assert abs(found[1]) < 200


def test_the_target_has_the_critic_s_statistics() -> None:
    """After one update both are in units of the same return and see states in the same units."""
    critic = EnsembleQ(hidden=(8,), scale=True, normalise=True)
    sac = replace(learner("sac", discount=0.9), critic=critic)
    first = begun(sac, SPEC)

    def at_seven(key: Array) -> Batch:
        return batch(key, 0.0)._replace(obs=jnp.full((B, 1), 7.0), reward=jnp.ones(B))

    state, _ = learned(sac, SPEC, at_seven, 1)
    assert float(state.target["value"].magnitude[0]) == pytest.approx(10)
    assert float(state.target["state"].mean[0]) == pytest.approx(7)
    for old, new, target in zip(
        *(jax.tree.leaves(made["weights"]) for made in (first.critic, state.critic, state.target)),
        strict=True,
    ):
        np.testing.assert_allclose(target, 0.95 * old + 0.05 * new, rtol=1e-5, atol=1e-8)
