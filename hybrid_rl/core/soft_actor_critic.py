"""The steps of actor-critic learners: a critic towards targets, a policy, a temperature.

    y      = r + gamma (1 - terminated) (min_i Q'_i(x', u') - alpha log pi(u'|x')),  u' ~ pi(x')
    L_Q    = 0.5 sum_i mean w (Q_i(x, u) - y)^2
    L_a    = -log(alpha) mean (log pi(v|x) + target),     v ~ pi(x)

Source: Haarnoja et al. 2018b.
"""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.core.optimisers import adam_step
from hybrid_rl.types import Batch, Spec


@struct.dataclass
class SACState:
    """Policy, critic and temperature, with their optimisers."""

    policy: Any
    critic: Any
    target: Any
    log_alpha: Array  # []
    policy_optimiser: Any
    critic_optimiser: Any
    alpha_optimiser: Any


def init(part: Any, key: Array, spec: Spec) -> SACState:
    """The initial state of `part`, a learner with the fields of SAC. The key is consumed."""
    for_policy, for_critic = jax.random.split(key)
    policy, critic = part.policy.init(for_policy, spec), part.critic.init(for_critic, spec)
    log_alpha = jnp.log(jnp.float32(part.alpha))
    return SACState(
        policy,
        critic,
        jax.tree.map(jnp.copy, critic),
        log_alpha,
        optax.adam(part.policy_learning_rate).init(policy),
        optax.adam(part.critic_learning_rate).init(critic),
        optax.adam(part.alpha_learning_rate).init(log_alpha),
    )


def observed(part: Any, state: Any, batch: Batch) -> Any:
    """`state` with the running statistics of the states and rewards in `batch`."""
    x, values = batch.obs, batch.reward / (1 - part.discount)
    policy, critic = part.policy, part.critic
    return state.replace(
        policy=policy.observe(state.policy, x), critic=critic.observe(state.critic, x, values)
    )


def target(part: Any, state: Any, alpha: Array, batch: Batch, noise: Array) -> Array:
    """y [B] = r + gamma (1 - terminated) (min_i Q'_i(x', u') - alpha log pi(u'|x'))."""
    v, log_prob = part.policy.sample(state.policy, batch.next_obs, noise)
    after = part.critic.value(state.target, batch.next_obs, v) - alpha * log_prob
    return batch.reward + part.discount * (1 - batch.terminated) * after


def critic_step(
    part: Any,
    state: Any,
    x: Array,
    u: Array,
    y: Array,
    weight: Array | None = None,
    factor: Array | float = 1.0,
) -> tuple[Any, tuple[Array, Array]]:
    """`state` after a step towards targets y [B] at x [B, n], u [B, m]; the loss and the mean Q.

    weight: [B] of each target; None: 1. factor: of the learning rate.
    """

    def loss(critic: Any) -> tuple[Array, Array]:
        q = part.critic.all(critic, x, u)
        error = (q - y[None]) ** 2
        error = error if weight is None else weight[None] * error
        return 0.5 * jnp.sum(jnp.mean(error, axis=-1)), q.mean()

    (value, q), grads = jax.value_and_grad(loss, has_aux=True)(state.critic)
    rate, optimiser = factor * part.critic_learning_rate, state.critic_optimiser
    critic, optimiser = adam_step(rate, grads, optimiser, state.critic)
    return state.replace(critic=critic, critic_optimiser=optimiser), (value, q)


def policy_step(
    part: Any,
    state: Any,
    loss: Callable[[Any], Any],
    limit: float | None = None,
    factor: Array | float = 1.0,
) -> tuple[Any, tuple[Array, Any, Array]]:
    """`state` after a step down `loss(policy) -> (value [], more)`; value, more, gradient's norm.

    limit: of the norm; None: none. factor: of the learning rate.
    """
    (value, more), grads = jax.value_and_grad(loss, has_aux=True)(state.policy)
    norm = optax.tree.norm(grads)
    if limit is not None:
        shrunk = jnp.minimum(1.0, limit / jnp.maximum(norm, 1e-12))
        grads = jax.tree.map(lambda g: g * shrunk, grads)
    rate, optimiser = factor * part.policy_learning_rate, state.policy_optimiser
    policy, optimiser = adam_step(rate, grads, optimiser, state.policy)
    return state.replace(policy=policy, policy_optimiser=optimiser), (value, more, norm)


def temperature_and_target(
    part: Any, state: SACState, entropy: Array, actions: int, factor: Array | float = 1.0
) -> SACState:
    """`state` with a step of the temperature for `entropy` [], and the target critic following.

    factor: of the learning rate.
    """
    aim = -actions if part.target_entropy is None else part.target_entropy
    log_alpha, optimiser = adam_step(
        factor * part.alpha_learning_rate, entropy - aim, state.alpha_optimiser, state.log_alpha
    )
    target = statistics.soft_target_update(state.target, state.critic, part.tau)
    return state.replace(target=target, log_alpha=log_alpha, alpha_optimiser=optimiser)
