"""Soft actor-critic with a categorical critic, batch normalisation and unit weights (FlashSAC).

    q     = distribution of r / scale + gamma (1 - terminated) (Z' - alpha log pi(u'|x'))
    L_Q   = -mean sum_k q_k log p_k(x, u)
    L_pi  = mean (alpha log pi(v|x) - min_i Q_i(x, v)),                             v ~ pi(x)
    L_a   = -alpha mean (log pi(v|x) + m log(sigma sqrt(2 pi e)))

Z' is the target critic's return with the smaller mean, `scale` that of hybrid_rl.learners
.return_scale. Critic and target see (x, u) and (x', u') as one batch, and are normalised by it
together (CrossQ, Bhatt et al. 2024); the policy sees x and x' so. After each gradient step the
weights are projected to unit norm. One update is a step of policy and temperature, then `batches`
steps of the critic. Source: FlashSAC (Kim et al. 2026), with its settings for one environment; its
learning rate falls by half over 1,000,000 decisions, here it is constant.
"""

import math
from dataclasses import KW_ONLY
from typing import Annotated, Any

import jax
import jax.numpy as jnp
import optax
from jax import Array

from hybrid_rl.core.actor_critic import ActorCritic, ActorCriticState, adam_step
from hybrid_rl.fields import Count, Positive, Share, has, part
from hybrid_rl.networks.normalised import constrained
from hybrid_rl.protocols import Critic, LearnedPolicy
from hybrid_rl.types import Batch, Params, Spec


@part
class FlashSAC(ActorCritic):
    """Soft actor-critic on a batch normalised policy and a categorical critic.

    Its rewards are divided by `params.scale`, the scale of returns.
    """

    policy: Annotated[LearnedPolicy, has("in_batch", "needs policy=unit_gaussian")]
    critic: Annotated[Critic, has("in_batch", "needs critic=categorical_q")]
    _: KW_ONLY
    learning_rate: Positive = 3e-4
    alpha: Positive = 0.01  # initial temperature, for scaled rewards
    target_sigma: Positive = 0.15  # of the normal distribution with the entropy that is aimed at
    tau: Share = 0.01
    batch_size: Count = 512
    batches: Count = 2  # steps of the critic for each step of the policy
    updates: float = 0.5  # steps of the policy per decision

    @property
    def _batched(self) -> tuple[Any, Any]:
        """Policy and critic; their parameters hold "weights" and "statistics" of batches."""
        return self.policy, self.critic

    def init(self, key: Array, spec: Spec) -> ActorCriticState:
        """Initial parameters, optimisers of their "weights", and target. The key is consumed."""
        return self.begun(key, spec, self.alpha, lambda params: params["weights"])

    def update(
        self, state: ActorCriticState, params: Params, batch: Batch, key: Array
    ) -> tuple[ActorCriticState, dict[str, Array]]:
        """A step of policy and temperature, then `batches` of the critic. The key is consumed."""
        acting, *following = jax.random.split(key, 1 + self.batches)
        rate = self.learning_rate * self.factor(params)
        batch = batch._replace(reward=batch.reward / params.scale, next_action=None)
        size = len(batch.reward) // self.batches
        stacked = jax.tree.map(lambda v: v.reshape(self.batches, size, *v.shape[1:]), batch)
        state, metrics = self._improved(state, jax.tree.map(lambda v: v[0], stacked), acting, rate)
        for i, key_i in enumerate(following):
            part = jax.tree.map(lambda v, i=i: v[i], stacked)
            state, of_critic = self._evaluated(state, part, key_i, rate)
            metrics |= of_critic
        return state, metrics

    def _improved(
        self, state: ActorCriticState, batch: Batch, key: Array, rate: Array | float
    ) -> tuple[ActorCriticState, dict[str, Array]]:
        """One step of policy and temperature. The key is consumed."""
        both, b = jnp.concatenate([batch.obs, batch.next_obs]), len(batch.obs)
        noise = jax.random.normal(key, (2 * b, batch.action.shape[-1]))
        alpha = jnp.exp(state.log_alpha)

        def loss(weights: Any) -> tuple[Array, tuple[Array, Any]]:
            known = {**state.policy, "weights": weights}
            v, log_prob, known = self._batched[0].in_batch(known, both, noise)
            q = self.critic.value(state.critic, batch.obs, v[:b])
            return jnp.mean(alpha * log_prob[:b] - q), (-log_prob[:b].mean(), known["statistics"])

        (of_policy, (entropy, statistics)), grads = jax.value_and_grad(loss, has_aux=True)(
            state.policy["weights"]
        )
        weights, optimiser = adam_step(rate, grads, state.policy_optimiser, state.policy["weights"])
        policy = {"weights": constrained(weights), "statistics": statistics}
        aim = batch.action.shape[-1] * math.log(self.target_sigma * math.sqrt(2 * math.pi * math.e))
        log_alpha, alpha_optimiser = adam_step(
            rate, alpha * (entropy - aim), state.alpha_optimiser, state.log_alpha
        )
        metrics = {"sac/policy_loss": of_policy, "sac/alpha": alpha, "sac/entropy": entropy}
        return state.replace(
            policy=policy,
            policy_optimiser=optimiser,
            log_alpha=log_alpha,
            alpha_optimiser=alpha_optimiser,
        ), metrics

    def _evaluated(
        self, state: ActorCriticState, batch: Batch, key: Array, rate: Array | float
    ) -> tuple[ActorCriticState, dict[str, Array]]:
        """One step of the critic and its target. The key is consumed."""
        b, noise = len(batch.obs), jax.random.normal(key, batch.action.shape)
        after, log_prob = self.policy.sample(state.policy, batch.next_obs, noise)
        x = jnp.concatenate([batch.obs, batch.next_obs])
        u = jnp.concatenate([batch.action, after])
        log_p, _ = self._batched[1].in_batch(state.target, x, u)
        factor = self.discount * (1 - batch.terminated)
        penalty = jnp.exp(state.log_alpha) * log_prob
        q = self._batched[1].target(log_p[:, b:], batch.reward, factor, penalty)

        def loss(weights: Any) -> tuple[Array, Any]:
            log_p, known = self._batched[1].in_batch({**state.critic, "weights": weights}, x, u)
            return -(q[None] * log_p[:, :b]).sum(-1).mean(), known["statistics"]

        (of_critic, statistics), grads = jax.value_and_grad(loss, has_aux=True)(
            state.critic["weights"]
        )
        weights, optimiser = adam_step(rate, grads, state.critic_optimiser, state.critic["weights"])
        critic = {"weights": constrained(weights), "statistics": statistics}
        target = optax.incremental_update(critic, state.target, self.tau)
        state = state.replace(critic=critic, critic_optimiser=optimiser, target=target)
        return state, {"sac/critic_loss": of_critic}
