"""Soft actor-critic (Haarnoja et al. 2018b): twin Q, reparameterised, learned temperature.

    y      = r + gamma (1 - terminated) (min_i Q'_i(x', u') - alpha log pi(u'|x')),  u' ~ pi(x')
    L_Q    = 0.5 sum_i mean (Q_i(x, u) - y)^2
    L_pi   = mean (alpha log pi(v|x) - min_i Q_i(x, v)),                             v ~ pi(x)
    L_a    = -log(alpha) mean (log pi(v|x) + target),     Q' <- (1 - tau) Q' + tau Q

With a `lookahead` the policy maximises the soft return V_0 of H decisions in a model instead, from
the states of the batch; with `expand` the critic learns the y_t of the same H decisions, and
nothing from the batch's own transitions (both in `core.soft_return`). A time limit does not
terminate the task: `truncated` is not used.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.core import soft_return, statistics
from hybrid_rl.core.ranges import above_zero, discount_and_tau
from hybrid_rl.protocols import Critic, Imagination, LearnedPolicy
from hybrid_rl.types import Batch, Imagined, Params, Spec


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
    policy_learning_rate: float = 3e-4
    critic_learning_rate: float = 3e-4
    alpha_learning_rate: float = 3e-4
    alpha: float = 1.0  # initial temperature
    target_entropy: float | None = None  # [nat]; None: -m
    discount: float = 0.99
    tau: float = 0.005
    batch_size: int = 256
    updates: float = 1  # per decision
    early: bool = False  # whether it also learns while decisions are random
    lookahead: Imagination | None = None  # the policy maximises V_0; None: the critic
    expand: bool = False  # the critic learns from the lookahead, too
    max_grad_norm: float | None = None  # of the policy's gradient; None: no limit

    data: ClassVar[str] = "uniform"
    owns: ClassVar[tuple[str, ...]] = ("policy", "critic")
    batches: ClassVar[int] = 1

    def __post_init__(self) -> None:
        """Check the fields."""
        discount_and_tau(self)
        above_zero(self, "policy_learner", "policy_learning_rate", "critic_learning_rate", "alpha")
        if self.max_grad_norm is not None and not self.max_grad_norm > 0:
            raise ValueError(
                f"policy_learner.max_grad_norm={self.max_grad_norm}: must be above 0, or null"
            )
        if self.expand and self.lookahead is None:
            raise ValueError(
                "policy_learner.expand=true: needs policy_learner.lookahead=${lookahead}"
            )

    def init(self, key: Array, spec: Spec) -> SACState:
        """Initial parameters, optimisers and target. The key is consumed."""
        for_policy, for_critic = jax.random.split(key)
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
        alpha = jnp.exp(state.log_alpha)
        state = state.replace(
            policy=self.policy.observe(state.policy, batch.obs),
            critic=self.critic.observe(state.critic, batch.obs, batch.reward / (1 - self.discount)),
        )
        acting, ahead = jax.random.split(key)
        noise = jax.random.normal(acting, (2, *batch.action.shape))
        if self.expand:
            state, paths, of_policy = self._improved(state, params, alpha, batch, ahead, noise[1])
            state, of_critic = self._expanded(state, alpha, paths)
        else:
            y = self._target(state, alpha, batch, noise[0])
            weight = jnp.ones_like(y)
            state, of_critic = self._evaluated(state, batch.obs, batch.action, y, weight)
            state, _, of_policy = self._improved(state, params, alpha, batch, ahead, noise[1])

        target_entropy = self.target_entropy
        if target_entropy is None:
            target_entropy = -batch.action.shape[-1]
        log_alpha, alpha_optimiser = _adam(
            self.alpha_learning_rate,
            of_policy["sac/entropy"] - target_entropy,
            state.alpha_optimiser,
            state.log_alpha,
        )
        target = statistics.following(state.target, state.critic, self.tau)
        metrics = {**of_critic, **of_policy, "sac/alpha": alpha}
        return state.replace(
            target=target, log_alpha=log_alpha, alpha_optimiser=alpha_optimiser
        ), metrics

    def _evaluated(
        self, state: SACState, x: Array, u: Array, y: Array, weight: Array
    ) -> tuple[SACState, dict[str, Array]]:
        """The critic after a step towards targets y [B] at x [B, n] and u [B, m], and metrics."""

        def loss(critic: Any) -> tuple[Array, Array]:
            q = self.critic.all(critic, x, u)
            return 0.5 * jnp.sum(jnp.mean(weight[None] * (q - y[None]) ** 2, axis=-1)), q.mean()

        (value, q), grads = jax.value_and_grad(loss, has_aux=True)(state.critic)
        critic, optimiser = _adam(
            self.critic_learning_rate, grads, state.critic_optimiser, state.critic
        )
        metrics = {"sac/critic_loss": value, "sac/q": q}
        return state.replace(critic=critic, critic_optimiser=optimiser), metrics

    def _expanded(
        self, state: SACState, alpha: Array, paths: Imagined
    ) -> tuple[SACState, dict[str, Array]]:
        """The critic after a step towards the returns along `paths`, and metrics."""
        paths = jax.lax.stop_gradient(paths)
        last = self.critic.value(state.target, paths.x[-1], paths.u[-1])
        y = soft_return.returns(paths, alpha, self.discount, last)
        x, u = (each[:-1].reshape(-1, each.shape[-1]) for each in (paths.x, paths.u))
        return self._evaluated(state, x, u, y.ravel(), soft_return.reached(paths).ravel())

    def _improved(
        self,
        state: SACState,
        params: Params,
        alpha: Array,
        batch: Batch,
        key: Array,
        noise: Array,
    ) -> tuple[SACState, Any, dict[str, Array]]:
        """The policy after a step from the states of `batch`, the lookahead, and metrics.

        The key is consumed by the lookahead, noise [B, m] by decisions without one.
        """
        params = params._replace(critic=state.critic)

        def loss(policy: Any) -> tuple[Array, tuple[Array, Any]]:
            known = params._replace(policy=policy)
            if self.lookahead is None:
                v, log_prob = self.policy.sample(policy, batch.obs, noise)
                value = self.critic.value(state.critic, batch.obs, v) - alpha * log_prob
                return -value.mean(), (log_prob, None)
            paths = self.lookahead.imagine(known, batch.obs, batch.action.shape[-1], key)
            last = self.critic.value(state.critic, paths.x[-1], paths.u[-1])
            y = soft_return.returns(paths, alpha, self.discount, last)
            return -(y[0] - alpha * paths.log_prob[0]).mean(), (paths.log_prob[0], paths)

        (value, (log_prob, paths)), grads = jax.value_and_grad(loss, has_aux=True)(state.policy)
        norm = optax.tree.norm(grads)
        if self.max_grad_norm is not None:
            shrunk = jnp.minimum(1.0, self.max_grad_norm / jnp.maximum(norm, 1e-12))
            grads = jax.tree.map(lambda g: g * shrunk, grads)
        policy, optimiser = _adam(
            self.policy_learning_rate, grads, state.policy_optimiser, state.policy
        )
        metrics = {
            "sac/policy_loss": value,
            "sac/entropy": -log_prob.mean(),
            "sac/gradient_norm": norm,
        }
        return state.replace(policy=policy, policy_optimiser=optimiser), paths, metrics

    def _target(self, state: SACState, alpha: Array, batch: Batch, noise: Array) -> Array:
        """The target y [B], without gradient."""
        v, log_prob = self.policy.sample(state.policy, batch.next_obs, noise)
        after = self.critic.value(state.target, batch.next_obs, v) - alpha * log_prob
        return batch.reward + self.discount * (1 - batch.terminated) * after


def _adam(rate: float, grads: Any, optimiser: Any, params: Any) -> tuple[Any, Any]:
    """One Adam step: new parameters, new optimiser state."""
    change, optimiser = optax.adam(rate).update(grads, optimiser, params)
    return optax.apply_updates(params, change), optimiser
