"""The Bellman target of soft actor-critic, from numbers."""

from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import numpy as np
import optax
import pytest

from hybrid_rl.core import soft_actor_critic as steps
from hybrid_rl.types import Batch

LOG_PROB, Q = -0.7, 3.0


def test_the_target_is_the_reward_and_the_discounted_soft_value_unless_it_ends() -> None:
    """y = r + gamma (1 - terminated) (Q' - alpha log pi); a time limit is no end."""
    sample = lambda policy, x, noise: (x[:, :1], jnp.full(len(x), LOG_PROB))  # noqa: E731
    value = lambda critic, x, u: jnp.full(len(x), Q)  # noqa: E731
    part: Any = SimpleNamespace(
        policy=SimpleNamespace(sample=sample), critic=SimpleNamespace(value=value), discount=0.9
    )
    state = SimpleNamespace(policy=None, target=None)
    x, zero = jnp.zeros((3, 2)), jnp.zeros(3)
    reward, terminated = jnp.array([1.0, 2.0, 3.0]), jnp.array([0.0, 1.0, 0.0])
    batch = Batch(x, x[:, :1], reward, terminated, zero.at[2].set(1.0), x)
    y = steps.target(part, state, jnp.float32(0.2), batch, x[:, :1])
    after = 0.9 * (Q - 0.2 * LOG_PROB)
    np.testing.assert_allclose(y, [1 + after, 2, 3 + after], rtol=1e-6)


@pytest.mark.parametrize(("limit", "share"), [(None, 1.0), (10.0, 1.0), (0.5, 0.1)])
def test_a_policy_s_gradient_is_no_longer_than_its_limit(limit: float | None, share: float) -> None:
    """Adam, whose first step is as long for any gradient, remembers a tenth of what it got."""
    part = SimpleNamespace(policy_learning_rate=0.1)
    policy = jnp.zeros(2)
    state = steps.SACState(policy, *[None] * 3, optax.adam(0.1).init(policy), None, None)
    loss = lambda policy: (policy @ jnp.array([3.0, -4.0]), None)  # noqa: E731
    state, (_, _, norm) = steps.policy_step(part, state, loss, limit)
    assert float(norm) == 5
    np.testing.assert_allclose(state.policy_optimiser[0].mu, [0.3 * share, -0.4 * share], rtol=1e-5)
    np.testing.assert_allclose(state.policy, [-0.1, 0.1], rtol=1e-5)
