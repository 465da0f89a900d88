"""The Bellman target of soft actor-critic, from numbers."""

from types import SimpleNamespace
from typing import Any, cast

import jax
import jax.numpy as jnp
import numpy as np
import optax
import pytest

from hybrid_rl.core.actor_critic import ActorCriticState, SoftActorCritic
from hybrid_rl.types import Batch, Params

LOG_PROB, Q = -0.7, 3.0


def test_the_target_is_the_reward_and_the_discounted_soft_value_unless_it_ends() -> None:
    """y = r + gamma (1 - terminated) (Q' - alpha log pi); a time limit is no end."""
    sample = lambda policy, x, noise: (x[:, :1], jnp.full(len(x), LOG_PROB))  # noqa: E731
    q = lambda critic, x, u: jnp.zeros((1, len(x)))  # noqa: E731
    value = lambda critic, x, u: jnp.full(len(x), critic)  # noqa: E731
    policy: Any = SimpleNamespace(sample=sample)
    critic: Any = SimpleNamespace(value=value, all=q)
    learner = SoftActorCritic(policy, critic, discount=0.9)
    state = ActorCriticState(None, 0.0, Q, None, optax.adam(1.0).init(0.0), None, jnp.log(0.2))
    x, zero = jnp.zeros((3, 2)), jnp.zeros(3)
    reward, terminated = jnp.array([1.0, 2.0, 3.0]), jnp.array([0.0, 1.0, 0.0])
    batch = Batch(x, x[:, :1], reward, terminated, zero.at[2].set(1.0), x)
    after = 0.9 * (Q - 0.2 * LOG_PROB)
    for k, y in enumerate((1 + after, 2.0, 3 + after)):
        one = jax.tree.map(lambda leaf, k=k: leaf[k : k + 1], batch)
        made = learner.recorded(state, one, x[:1, :1])
        _, found = learner.evaluated(state, made, 1, Params())
        assert float(found["sac/critic_loss"]) == pytest.approx(0.5 * y**2, rel=1e-5)


@pytest.mark.parametrize(("limit", "share"), [(None, 1.0), (10.0, 1.0), (0.5, 0.1)])
def test_a_policy_s_gradient_is_no_longer_than_its_limit(limit: float | None, share: float) -> None:
    """Adam, whose first step is as long for any gradient, remembers a tenth of what it got."""
    policy, part = jnp.zeros(2), SoftActorCritic(*[cast(Any, None)] * 2)
    state = ActorCriticState(policy, None, None, optax.adam(0.1).init(policy), None)
    loss = lambda policy: (policy @ jnp.array([3.0, -4.0]), None)  # noqa: E731
    state, (_, _, norm) = part.policy_step(state, 0.1, loss, limit)
    assert float(norm) == 5
    np.testing.assert_allclose(state.policy_optimiser[0].mu, [0.3 * share, -0.4 * share], rtol=1e-5)
    np.testing.assert_allclose(state.policy, [-0.1, 0.1], rtol=1e-5)
