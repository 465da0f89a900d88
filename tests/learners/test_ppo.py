"""Proximal policy optimisation: its advantages by hand, and a problem with a known answer."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.learners.ppo import PPO
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.types import Batch, Params, Spec

SPEC, E, T = Spec(obs=1, act=1, dt=1.0), 32, 4
SMALL = PPO(TanhGaussian(hidden=(16,)), E, T, epochs=4, minibatches=3, discount=0.5, hidden=(16,))


def decided(u, obs, next_obs, reward, terminated=0.0, truncated=0.0):
    """A round [E]."""
    flags = (jnp.full(E, float(flag)) for flag in (terminated, truncated))
    return Batch(obs, u, reward, *flags, next_obs)


def test_the_advantages_are_those_of_a_plain_loop():
    """Over two episodes; the first ends for good in half of the worlds, in time in the others."""
    rng, half = np.random.default_rng(0), np.arange(E) < E // 2
    state = SMALL.init(jax.random.key(0), SPEC)
    obs, after = rng.normal(size=(2, T, E, 1)).astype("f")
    reward, ends = rng.normal(size=(T, E)).astype("f"), np.zeros((T, E), "f")
    ends[1] = 1
    made = Batch(obs, np.zeros_like(obs), reward, ends * half, ends * ~half, after)
    found, values = SMALL.advantages(state.replace(decisions=made), 2.0)

    def value(x):
        return np.asarray(SMALL._value(state, state.value, jnp.asarray(x)))

    later, wanted = np.zeros(E), np.zeros((T, E))
    for t in reversed(range(T)):
        going = 1 - made.terminated[t]
        delta = reward[t] / 2 + 0.5 * going * value(after[t]) - value(obs[t])
        later = delta + 0.5 * 0.95 * (1 - ends[t]) * later
        wanted[t] = later
    np.testing.assert_allclose(found, wanted, rtol=1e-4, atol=1e-5)
    np.testing.assert_allclose(values, value(obs), rtol=1e-5)


@pytest.mark.parametrize("target_kl", [None, 0.02])
@pytest.mark.parametrize("terminated", [1.0, 0.0])
def test_the_best_action_and_its_value_are_found(terminated, target_kl):
    """Reward 1 - (u - 0.5)^2 in one state; a time limit is bootstrapped through, a fall is not."""
    made = replace(SMALL, learning_rate=3e-3, entropy=0.001, target_kl=target_kl)
    zero = jnp.zeros((E, 1))

    def one(state, at):
        step, key = at
        acting, learning = jax.random.split(key)
        noise = jax.random.normal(acting, (E, 1))
        u = made.policy.sample(state.policy, zero, noise)[0]
        new = decided(u, zero, zero, 1 - (u[:, 0] - 0.5) ** 2, terminated, 1 - terminated)
        state, metrics = made.update(state, Params(decisions=step * E), new, learning)
        return state, metrics["ppo/kl"]

    first = made.init(jax.random.key(1), SPEC)
    given = jnp.arange(T * 150), jax.random.split(jax.random.key(2), T * 150)
    state, kl = jax.jit(lambda s, g: jax.lax.scan(one, s, g))(first, given)
    assert float(made.policy.mean(state.policy, jnp.zeros(1))[0]) == pytest.approx(0.5, abs=0.1)
    value = float(made._value(state, state.value, jnp.zeros(1)))
    assert value == pytest.approx(1.0 if terminated else 2.0, abs=0.15)
    assert np.isfinite(kl).all()


def test_nothing_is_learned_before_the_unroll_is_over():
    state, zero = SMALL.init(jax.random.key(0), SPEC), jnp.zeros((E, 1))
    new = decided(zero, zero, zero, jnp.ones(E))
    for step in range(T):
        before = state
        state, _ = SMALL.update(state, Params(decisions=step * E), new, jax.random.key(step))
        same = jax.tree.map(lambda a, b: bool((a == b).all()), before.value, state.value)
        assert all(jax.tree.leaves(same)) == (step < T - 1)
