"""The soft return of a policy over H decisions of a learned model, for its gradient.

    R(x_0) = sum_{t<H} c_t (r_t - alpha log pi_t) + c_H (min_i Q_i(x_H, u_H) - alpha log pi_H)
    u_t ~ pi(x_t),   x_{t+1} ~ f(x_t, u_t),   c_t = discount^t times the chance to continue

The gradient of R by the policy's parameters goes through actions, model, reward and critic, with
the noise fixed: stochastic value gradients (Heess et al. 2015), here with the maximum-entropy
return, as in MAAC (Clavera et al. 2020). For H = 0 it is the policy's objective in SAC.
"""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.protocols import Critic, LearnedPolicy, Reward, Trainable
from hybrid_rl.types import Params


@dataclass(frozen=True)
class Lookahead:
    """H = `steps` decisions ahead by `model` and `reward`.

    Raises:
        ValueError: for a number of steps that is not a positive integer.
    """

    model: Trainable
    reward: Reward
    policy: LearnedPolicy
    critic: Critic
    steps: int = 3  # H

    def __post_init__(self) -> None:
        """Check the fields."""
        if not isinstance(self.steps, int) or self.steps < 1:
            raise ValueError(f"lookahead.steps={self.steps}: must be a whole number, 1 or more")

    def value(
        self, params: Params, alpha: Array, discount: float, x: Array, m: int, key: Array
    ) -> tuple[Array, Array]:
        """R [B] from planning states x [B, n], and log pi(u_0|x_0) [B]. The key is consumed."""
        acting, moving, choosing = jax.random.split(key, 3)
        length = self.steps
        for_policy = jax.random.normal(acting, (length + 1, len(x), m))
        for_model = jax.random.normal(moving, (length, *x.shape))
        outcome = jax.vmap(self.reward.outcome, (None, 0, 0))

        def forward(carry: Any, at: Any) -> Any:
            x, weight, total = carry
            noise, model_noise, key = at
            u, log_prob = self.policy.sample(params.policy, x, noise)
            r, end = outcome(params.reward, x, u)
            total = total + weight * (r - alpha * log_prob)
            after = self.model.draw(params.model, x, u, model_noise, key)
            return (after, weight * discount * jax.nn.sigmoid(-end), total), log_prob

        first = x, jnp.ones(len(x)), jnp.zeros(len(x))
        along = for_policy[:-1], for_model, jax.random.split(choosing, length)
        (x, weight, total), log_probs = jax.lax.scan(forward, first, along, unroll=length)
        u, log_prob = self.policy.sample(params.policy, x, for_policy[-1])
        last = self.critic.value(params.critic, x, u) - alpha * log_prob
        return total + weight * last, log_probs[0]
