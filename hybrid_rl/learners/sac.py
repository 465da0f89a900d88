"""Soft actor-critic (Haarnoja et al. 2018b): twin Q, reparameterised, learned temperature.

    y      = r + gamma (1 - terminated) (min_i Q'_i(x', u') - alpha log pi(u'|x')),  u' ~ pi(x')
    L_Q    = 0.5 sum_i mean (Q_i(x, u) - y)^2
    L_pi   = mean (alpha log pi(v|x) - min_i Q_i(x, v)),                             v ~ pi(x)
    L_a    = -log(alpha) mean (log pi(v|x) + target),     Q' <- (1 - tau) Q' + tau Q

With a `lookahead` the policy maximises the soft return of several decisions in a model. A time
limit does not terminate the task: `truncated` is not used.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.core.lifting import lifted_batch, lifted_spec
from hybrid_rl.protocols import Critic, LearnedPolicy, Model, PolicyReturn
from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class SACState:
    """The state of soft actor-critic."""

    policy: Any
    critic: Any
    target: Any
    log_alpha: Array  # []
    policy_optimiser: Any
    critic_optimiser: Any
    alpha_optimiser: Any


@dataclass(frozen=True)
class SAC:
    """Soft actor-critic on a policy and a critic.

    Raises:
        ValueError: for rates, a discount or tau out of range.
    """

    policy: LearnedPolicy
    critic: Critic
    model: Model | None = None  # lifts observations to planning states; None: they are the same
    policy_learning_rate: float = 3e-4
    critic_learning_rate: float = 3e-4
    alpha_learning_rate: float = 3e-4
    alpha: float = 1.0  # initial temperature
    target_entropy: float | None = None  # [nat]; None: -m
    discount: float = 0.99
    tau: float = 0.005
    batch_size: int = 256
    updates: float = 1  # per decision
    lookahead: PolicyReturn | None = None  # what the policy maximises; None: the critic
    max_grad_norm: float | None = None  # of the policy's gradient; None: no limit

    data: ClassVar[str] = "uniform"
    owns: ClassVar[tuple[str, ...]] = ("policy", "critic")
    batches: ClassVar[int] = 1
    early: ClassVar[bool] = False  # starts after the random decisions

    def __post_init__(self) -> None:
        """Check the fields."""
        if not 0 <= self.discount < 1:
            raise ValueError(f"policy_learner.discount={self.discount}: must lie in [0, 1)")
        if not 0 < self.tau <= 1:
            raise ValueError(f"policy_learner.tau={self.tau}: must lie in (0, 1]")
        for name in ("policy_learning_rate", "critic_learning_rate", "alpha"):
            if getattr(self, name) <= 0:
                raise ValueError(f"policy_learner.{name}={getattr(self, name)}: must be above 0")
        if self.max_grad_norm is not None and not self.max_grad_norm > 0:
            raise ValueError(
                f"policy_learner.max_grad_norm={self.max_grad_norm}: must be above 0, or null"
            )

    def init(self, key: Array, spec: Spec) -> SACState:
        """Initial parameters, optimisers and target. The key is consumed."""
        for_policy, for_critic = jax.random.split(key)
        spec = lifted_spec(self.model, spec)
        policy, critic = self.policy.init(for_policy, spec), self.critic.init(for_critic, spec)
        log_alpha = jnp.log(jnp.float32(self.alpha))
        return SACState(
            policy,
            critic,
            jax.tree.map(jnp.copy, critic),
            log_alpha,
            optax.adam(self.policy_learning_rate).init(policy),
            optax.adam(self.critic_learning_rate).init(critic),
            optax.adam(self.alpha_learning_rate).init(log_alpha),
        )

    def params(self, state: SACState) -> dict[str, Any]:
        """The policy and the critic."""
        return {"policy": state.policy, "critic": state.critic}

    def update(
        self, state: SACState, params: Params, batch: Batch, key: Array
    ) -> tuple[SACState, dict[str, Array]]:
        """One step of critic, policy, temperature and target. The key is consumed."""
        batch = lifted_batch(self.model, params.model, batch)
        noise = jax.random.normal(key, (2, *batch.action.shape))
        alpha = jnp.exp(state.log_alpha)
        state = state.replace(policy=self.policy.observe(state.policy, batch.obs))
        y = self._target(state, alpha, batch, noise[0])

        def critic_loss(critic: Any) -> tuple[Array, Array]:
            q = self.critic.all(critic, batch.obs, batch.action)
            return 0.5 * jnp.sum(jnp.mean((q - y[None]) ** 2, axis=-1)), q.mean()

        (of_critic, q), grads = jax.value_and_grad(critic_loss, has_aux=True)(state.critic)
        critic, critic_optimiser = _adam(
            self.critic_learning_rate, grads, state.critic_optimiser, state.critic
        )

        known = params._replace(critic=critic)
        policy, policy_optimiser, (of_policy, log_prob, norm) = self._improved(
            state, known, alpha, batch.obs, noise[1], key
        )
        entropy = -log_prob.mean()
        target_entropy = self.target_entropy
        if target_entropy is None:
            target_entropy = -batch.action.shape[-1]
        log_alpha, alpha_optimiser = _adam(
            self.alpha_learning_rate,
            entropy - target_entropy,
            state.alpha_optimiser,
            state.log_alpha,
        )
        target = optax.incremental_update(critic, state.target, self.tau)
        metrics = {
            "sac/critic_loss": of_critic,
            "sac/policy_loss": of_policy,
            "sac/alpha": alpha,
            "sac/entropy": entropy,
            "sac/q": q,
            "sac/gradient_norm": norm,
        }
        return SACState(
            policy, critic, target, log_alpha, policy_optimiser, critic_optimiser, alpha_optimiser
        ), metrics

    def _improved(
        self, state: SACState, params: Params, alpha: Array, x: Array, noise: Array, key: Array
    ) -> tuple[Any, Any, tuple[Array, Array, Array]]:
        """Policy, optimiser, and loss [], log pi [B] and the gradient's norm [] at x [B, n]."""

        def loss(policy: Any) -> tuple[Array, Array]:
            known = params._replace(policy=policy)
            value, log_prob = self._value(known, alpha, x, noise, key)
            return -value.mean(), log_prob

        (of_policy, log_prob), grads = jax.value_and_grad(loss, has_aux=True)(state.policy)
        norm = optax.tree.norm(grads)
        if self.max_grad_norm is not None:
            shrunk = jnp.minimum(1.0, self.max_grad_norm / jnp.maximum(norm, 1e-12))
            grads = jax.tree.map(lambda g: g * shrunk, grads)
        rate = self.policy_learning_rate
        policy, optimiser = _adam(rate, grads, state.policy_optimiser, state.policy)
        return policy, optimiser, (of_policy, log_prob, norm)

    def _value(
        self, params: Params, alpha: Array, x: Array, noise: Array, key: Array
    ) -> tuple[Array, Array]:
        """The soft return [B] that the policy maximises from x [B, n], and log pi [B] there."""
        if self.lookahead is not None:
            ahead = jax.random.fold_in(key, 1)
            m = noise.shape[-1]
            return self.lookahead.value(params, alpha, self.discount, x, m, ahead)
        v, log_prob = self.policy.sample(params.policy, x, noise)
        return self.critic.value(params.critic, x, v) - alpha * log_prob, log_prob

    def _target(self, state: SACState, alpha: Array, batch: Batch, noise: Array) -> Array:
        """The target y [B], without gradient."""
        v, log_prob = self.policy.sample(state.policy, batch.next_obs, noise)
        after = self.critic.value(state.target, batch.next_obs, v) - alpha * log_prob
        return batch.reward + self.discount * (1 - batch.terminated) * after


def _adam(rate: float, grads: Any, optimiser: Any, params: Any) -> tuple[Any, Any]:
    """One Adam step: new parameters, new optimiser state."""
    change, optimiser = optax.adam(rate).update(grads, optimiser, params)
    return optax.apply_updates(params, change), optimiser
