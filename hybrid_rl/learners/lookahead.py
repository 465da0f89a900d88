"""Decisions of a policy in a learned model, for the returns of `core.soft_return`.

    u_t ~ pi(x_t),   x_{t+1} ~ f(x_t, u_t),   r_t, c_t = reward(x_t, u_t, x_{t+1})

with c_t the chance that the episode continues. The gradient by the policy's parameters goes through
actions, model and reward, with the noise fixed (reparameterisation): stochastic value gradients
(Heess et al. 2015).
"""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.protocols import LearnedPolicy, Reward, Trainable
from hybrid_rl.types import Imagined, Params


@dataclass(frozen=True)
class Lookahead:
    """H = `steps` decisions ahead by `model` and `reward`.

    Raises:
        ValueError: for a number of steps that is not a positive integer.
    """

    model: Trainable
    reward: Reward
    policy: LearnedPolicy
    steps: int = 3  # H

    def __post_init__(self) -> None:
        """Check the fields."""
        if not isinstance(self.steps, int) or self.steps < 1:
            raise ValueError(f"lookahead.steps={self.steps}: must be a whole number, 1 or more")

    def imagine(self, params: Params, x: Array, m: int, key: Array) -> Imagined:
        """H decisions of size m from planning states x [B, n]. The key is consumed.

        Differentiable by `params.policy`.
        """
        acting, moving, choosing = jax.random.split(key, 3)
        length = self.steps
        for_policy = jax.random.normal(acting, (length + 1, len(x), m))
        for_model = jax.random.normal(moving, (length, *x.shape))

        def forward(x: Array, at: Any) -> Any:
            noise, model_noise, key = at
            u, log_prob = self.policy.sample(params.policy, x, noise)
            after = self.model.draw(params.model, x, u, model_noise, key)
            return after, (x, u, log_prob, after)

        along = for_policy[:-1], for_model, jax.random.split(choosing, length)
        last, (xs, us, log_probs, after) = jax.lax.scan(forward, x, along, unroll=length)
        outcome = jax.vmap(jax.vmap(self.reward.outcome, (None, 0, 0, 0)), (None, 0, 0, 0))
        rewards, ends = outcome(params, xs, us, after)  # of all decisions at once
        u, log_prob = self.policy.sample(params.policy, last, for_policy[-1])
        return Imagined(
            x=jnp.concatenate([xs, last[None]]),
            u=jnp.concatenate([us, u[None]]),
            log_prob=jnp.concatenate([log_probs, log_prob[None]]),
            reward=rewards,
            goes_on=jax.nn.sigmoid(-ends),
        )
