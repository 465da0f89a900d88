"""Soft actor-critic (Haarnoja et al. 2018b): twin Q, reparameterised, learned temperature.

    y      = r + gamma (1 - terminated) (min_i Q'_i(x', u') - alpha log pi(u'|x')),  u' ~ pi(x')
    L_Q    = 0.5 sum_i mean (Q_i(x, u) - y)^2
    L_pi   = mean (alpha log pi(v|x) - min_i Q_i(x, v)),                             v ~ pi(x)
    L_a    = -log(alpha) mean (log pi(v|x) + target),     Q' <- (1 - tau) Q' + tau Q

A time limit does not terminate the task: `truncated` is not used.
"""

from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.actor_critic import ActorCriticState, SoftActorCritic
from hybrid_rl.fields import part
from hybrid_rl.types import Batch, Imagined, Params, Spec


@part
class SAC(SoftActorCritic):
    """Soft actor-critic on a policy and a critic."""

    def init(self, key: Array, spec: Spec) -> ActorCriticState:
        """Initial parameters, optimisers and target. The key is consumed."""
        return self.begun(key, spec, self.alpha)

    def update(
        self, state: ActorCriticState, params: Params, batch: Batch, key: Array
    ) -> tuple[ActorCriticState, dict[str, Array]]:
        """One step of critic, policy, temperature and target. The key is consumed."""
        state = self.observed(state, batch)
        noise = jax.random.normal(jax.random.split(key)[0], (2, *batch.action.shape))
        recorded = self.recorded(state, batch, noise[0])
        state, of_critic = self.evaluated(state, recorded, 1, params)

        def now(policy: Any) -> Imagined:
            """No decision more than the first of the policy."""
            u, log_prob = self.policy.sample(policy, batch.obs, noise[1])
            none = jnp.zeros((0, len(u)))
            return Imagined(batch.obs[None], u[None], log_prob[None], none, none)

        state, along = self.improved(state, now, params)
        state, metrics = self.settled(state, along, params)
        return state, of_critic | metrics
