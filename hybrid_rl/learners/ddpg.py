"""Deep deterministic policy gradients (Lillicrap et al. 2016; thesis eq. 6.26).

    y    = r + gamma (1 - terminated) Q'(x', pi'(x'))
    L_Q  = 0.5 sum_i mean (Q_i(x, u) - y)^2,   L_pi = -mean Q(x, pi(x))
    Q'   <- (1 - tau) Q' + tau Q,              pi'  <- (1 - tau) pi' + tau pi

pi is the mean of any policy; the controller explores. Q is the minimum over the critic's members;
the original has one. A time limit does not terminate the task.
"""

from dataclasses import KW_ONLY
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.core.actor_critic import ActorCritic, ActorCriticState
from hybrid_rl.fields import Count, Positive, Share, part
from hybrid_rl.types import Batch, Params, Spec


@part
class DDPG(ActorCritic):
    """Deterministic policy gradients on the mean of a policy and a critic."""

    _: KW_ONLY
    policy_learning_rate: Positive = 1e-4
    critic_learning_rate: Positive = 1e-3
    tau: Share = 0.01
    batch_size: Count = 128

    def init(self, key: Array, spec: Spec) -> ActorCriticState:
        """Initial parameters, optimisers and targets. The key is consumed."""
        state = self.begun(key, spec)
        return state.replace(target_policy=jax.tree.map(jnp.copy, state.policy))

    def update(
        self, state: ActorCriticState, params: Params, batch: Batch, key: Array
    ) -> tuple[ActorCriticState, dict[str, Array]]:
        """One step of critic, policy and targets."""
        factor = self.factor(params)
        state = self.observed(state, batch)
        u = self.policy.mean(state.target_policy, batch.next_obs)
        after = self.critic.value(state.target, batch.next_obs, u)
        y = batch.reward + self.discount * (1 - batch.terminated) * after
        rate = factor * self.critic_learning_rate
        state, (of_critic, q) = self.critic_step(state, rate, batch.obs, batch.action, y)

        def loss(policy: Any) -> tuple[Array, None]:
            u = self.policy.mean(policy, batch.obs)
            return -jnp.mean(self.critic.value(state.critic, batch.obs, u)), None

        rate = factor * self.policy_learning_rate
        state, (of_policy, *_) = self.policy_step(state, rate, loss)
        metrics = {"ddpg/critic_loss": of_critic, "ddpg/policy_loss": of_policy, "ddpg/q": q}
        old, new = (state.target_policy, state.target), (state.policy, state.critic)
        policy, critic = statistics.soft_target_update(old, new, self.tau)
        return state.replace(target_policy=policy, target=critic), metrics
