"""The options of a learned reward."""

import jax
import jax.numpy as jnp
import numpy as np
from toys import begun

from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.hopper import Hopper
from hybrid_rl.rewards.network import RewardNetwork
from hybrid_rl.types import Params, Spec

SPEC = Spec(obs=3, act=2, dt=0.1)
X, U = jnp.array([0.3, -1.0, 2.0]), jnp.array([0.5, -0.2])


def test_scaled_rewards_are_in_real_units() -> None:
    """r = m + s f with the rewards' mean and deviation; the error counts in units of s."""
    plain = RewardNetwork(hidden=(8,), ends=True)
    scaled = RewardNetwork(hidden=(8,), ends=True, scale=True)
    rewards = np.random.default_rng(0).normal(300, 40, 100).astype(np.float32)
    first = begun(plain, SPEC)
    params = scaled.observe_targets(begun(scaled, SPEC), jnp.asarray(rewards))
    (f, logit), (r, same) = (
        plain.outcome(Params(reward=first), X, U, X),
        scaled.outcome(Params(reward=params), X, U, X),
    )
    assert same == logit
    np.testing.assert_allclose(r, rewards.mean() + rewards.std() * f, rtol=1e-5)
    target, ended = jnp.float32(333.0), jnp.float32(1.0)
    of_end = np.log1p(np.exp(logit)) - logit
    wanted = 0.5 * ((333 - float(r)) / rewards.std()) ** 2 + of_end
    np.testing.assert_allclose(scaled.loss(params, X, U, X, target, ended), wanted, rtol=1e-4)


def test_the_reward_of_several_networks_is_their_mean() -> None:
    """And their loss the mean of their losses."""
    one, several = (RewardNetwork(hidden=(8,), ends=True, members=k) for k in (1, 3))
    params = begun(several, SPEC)
    each = [
        {**params, "weights": jax.tree.map(lambda w, i=i: w[i], params["weights"])}
        for i in range(3)
    ]
    outcome, loss = jax.jit(one.outcome), jax.jit(one.loss)
    outcomes = np.array([outcome(Params(reward=member), X, U, X) for member in each])
    assert outcomes.std(0).min() > 1e-3
    got = several.outcome(Params(reward=params), X, U, X)
    np.testing.assert_allclose(got, outcomes.mean(0), rtol=1e-5)
    target, ended = jnp.float32(2.0), jnp.float32(1.0)
    losses = [loss(member, X, U, X, target, ended) for member in each]
    got = several.loss(params, X, U, X, target, ended)
    np.testing.assert_allclose(got, np.mean(losses), rtol=1e-5)


def test_the_next_state_is_an_input() -> None:
    """Against NumPy: f of (x - m) / s, u and (x' - m) / s, with the data's statistics."""
    reward = RewardNetwork(hidden=(8,), next_state=True)
    params = begun(reward, SPEC)
    x = np.random.default_rng(0).normal(2, 3, (50, 3)).astype(np.float32)
    params = reward.observe(params, jnp.asarray(x))
    after = X + jnp.array([0.3, -0.1, 0.2])
    w = jax.tree.map(lambda leaf: np.asarray(leaf, np.float64), params["weights"]["params"])
    m, s = x.mean(0), x.std(0)
    inputs = np.concatenate([(X - m) / s, U, (after - m) / s])
    hidden = np.maximum(inputs @ w["Dense_0"]["kernel"], 0)
    got = reward.outcome(Params(reward=params), X, U, after)[0]
    np.testing.assert_allclose(got, (hidden @ w["Dense_1"]["kernel"])[0], rtol=1e-3)


def test_ends_by_the_rule_of_a_task() -> None:
    """The rule decides by the next observation; nothing is learned about ends.

    A task without a rule learns them.
    """
    env = Hopper(physics="native")
    known = RewardNetwork(hidden=(8,), ends=True, rule=env)
    params = begun(known, env.spec)
    x, u = jnp.zeros(11), jnp.zeros(3)
    for height, sign in ((0.69, 1), (0.71, -1)):
        assert jnp.sign(known.outcome(Params(reward=params), x, u, x.at[0].set(height))[1]) == sign
    losses = [known.loss(params, x, u, x, jnp.float32(1), jnp.float32(end)) for end in (0, 1)]
    assert losses[0] == losses[1]
    learned = RewardNetwork(hidden=(8,), ends=True, rule=HalfCheetah(physics="native"))
    assert begun(learned, SPEC)["weights"]["params"]["Dense_1"]["bias"].size == 2
