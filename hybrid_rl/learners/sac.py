"""Soft actor-critic (Haarnoja et al. 2018b): twin Q, reparameterised, learned temperature.

    y      = r + gamma (1 - terminated) (min_i Q'_i(x', u') - alpha log pi(u'|x')),  u' ~ pi(x')
    L_Q    = 0.5 sum_i mean (Q_i(x, u) - y)^2
    L_pi   = mean (alpha log pi(v|x) - min_i Q_i(x, v)),                             v ~ pi(x)
    L_a    = -log(alpha) mean (log pi(v|x) + target),     Q' <- (1 - tau) Q' + tau Q

A time limit does not terminate the task: `truncated` is not used.
"""

from typing import Any, ClassVar

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import decay
from hybrid_rl.core import soft_actor_critic as steps
from hybrid_rl.core.soft_actor_critic import SACState
from hybrid_rl.fields import Count, Discount, NotNegative, Positive, Share, part
from hybrid_rl.protocols import Critic, LearnedPolicy, Schedule
from hybrid_rl.types import Batch, Params, Spec


@part
class SAC:
    """Soft actor-critic on a policy and a critic."""

    policy: LearnedPolicy
    critic: Critic
    policy_learning_rate: Positive = 3e-4
    critic_learning_rate: Positive = 3e-4
    alpha_learning_rate: NotNegative = 3e-4  # 0: alpha stays
    alpha: Positive = 1.0  # initial temperature
    target_entropy: float | None = None  # [nat]; None: -m
    discount: Discount = 0.99
    tau: Share = 0.005
    batch_size: Count = 256
    updates: float = 1  # per decision
    during_random: bool = False  # whether it also learns while decisions are random
    max_grad_norm: Positive | None = None  # of the policy's gradient; None: no limit
    schedule: Schedule | None = None  # of the learning rates

    data: ClassVar[str] = "uniform"
    owns: ClassVar[tuple[str, ...]] = ("policy", "critic")
    batches: ClassVar[int] = 1

    def init(self, key: Array, spec: Spec) -> SACState:
        """Initial parameters, optimisers and target. The key is consumed."""
        return steps.init(self, key, spec)

    def params(self, state: SACState) -> dict[str, Any]:
        """The policy and the critic."""
        return {"policy": state.policy, "critic": state.critic}

    def update(
        self, state: SACState, params: Params, batch: Batch, key: Array
    ) -> tuple[SACState, dict[str, Array]]:
        """One step of critic, policy, temperature and target. The key is consumed."""
        alpha, factor = jnp.exp(state.log_alpha), decay.of_rates(self.schedule, params.decisions)
        state = steps.observed(self, state, batch)
        noise = jax.random.normal(jax.random.split(key)[0], (2, *batch.action.shape))
        y = steps.target(self, state, alpha, batch, noise[0])
        state, (critic_loss, q) = steps.critic_step(
            self, state, batch.obs, batch.action, y, factor=factor
        )

        def loss(policy: Any) -> tuple[Array, Array]:
            v, log_prob = self.policy.sample(policy, batch.obs, noise[1])
            value = self.critic.value(state.critic, batch.obs, v) - alpha * log_prob
            return -value.mean(), log_prob

        state, (policy_loss, log_prob, norm) = steps.policy_step(
            self, state, loss, self.max_grad_norm, factor
        )
        entropy = -log_prob.mean()
        actions = batch.action.shape[-1]
        state = steps.temperature_and_target(self, state, entropy, actions, factor)
        return state, {
            "sac/critic_loss": critic_loss,
            "sac/q": q,
            "sac/policy_loss": policy_loss,
            "sac/entropy": entropy,
            "sac/gradient_norm": norm,
            "sac/alpha": alpha,
        }
