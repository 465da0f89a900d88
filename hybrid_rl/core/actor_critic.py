"""Actor-critic learning: the fields that its learners share, and the steps of an update.

    y    = returns along paths of decisions, recorded or imagined (`core.returns`)
    |y| <= (largest + alpha m) / (1 - discount),     largest: absolute reward so far, or infinity
    L_Q  = 0.5 sum_i mean w (Q_i(x, u) - y)^2
    L_pi = -mean V_0
    L_a  = -log(alpha) mean (log pi(v|x) + target),        v ~ pi(x)
    Q'  <- (1 - tau) Q' + tau Q

A recorded decision is a path of one decision, whose V_1 is that of the next state: y is the target
of soft actor-critic (Haarnoja et al. 2018b). A time limit does not terminate the task: `truncated`
is not used.
"""

from collections.abc import Callable
from dataclasses import KW_ONLY
from typing import Any, ClassVar, NamedTuple

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.core import decay, returns, statistics
from hybrid_rl.fields import Count, Discount, NotNegative, Positive, Share, part
from hybrid_rl.protocols import Critic, LearnedPolicy, Schedule
from hybrid_rl.types import Batch, Imagined, Params, PyTree, Spec


@struct.dataclass
class ActorCriticState:
    """Policy and critic with their optimisers, the critic's target, and what some have more."""

    policy: Any
    critic: Any
    target: Any  # of the critic
    policy_optimiser: Any
    critic_optimiser: Any
    target_policy: PyTree = None
    log_alpha: PyTree = None  # []
    alpha_optimiser: PyTree = None


class Along(NamedTuple):
    """What the policy's step saw."""

    loss: Array  # []
    entropy: Array  # [] of the first decisions
    norm: Array  # [] of the gradient
    paths: Imagined


@part
class ActorCritic:
    """A learner of a policy and a critic."""

    policy: LearnedPolicy
    critic: Critic
    _: KW_ONLY
    discount: Discount = 0.99
    tau: Share = 0.005  # of the target that is new, in each update
    batch_size: Count = 256
    updates: float = 1  # per decision
    schedule: Schedule | None = None  # of the learning rates

    data: ClassVar[str] = "uniform"
    owns: ClassVar[tuple[str, ...]] = ("policy", "critic")
    batches: ClassVar[int] = 1
    during_random: ClassVar[bool] = False  # whether it also learns while decisions are random

    def begun(
        self,
        key: Array,
        spec: Spec,
        alpha: float | None = None,
        learned: Callable[[Any], Any] = lambda params: params,
    ) -> ActorCriticState:
        """Initial parameters, optimisers and target. The key is consumed.

        alpha: of the temperature; None: it has none. learned: those of the parameters that
        gradients change.
        """
        log_alpha = None if alpha is None else jnp.log(jnp.float32(alpha))
        for_policy, for_critic = jax.random.split(key)
        policy, critic = self.policy.init(for_policy, spec), self.critic.init(for_critic, spec)
        target = jax.tree.map(jnp.copy, critic)
        each: tuple[PyTree, ...] = learned(policy), learned(critic), log_alpha
        of_policy, of_critic, of_alpha = map(optax.adam(1.0).init, each)
        state = ActorCriticState(policy, critic, target, of_policy, of_critic)
        return state.replace(log_alpha=log_alpha, alpha_optimiser=of_alpha)

    def params(self, state: Any) -> dict[str, Any]:
        """The policy and the critic."""
        return {"policy": state.policy, "critic": state.critic}

    def factor(self, params: Params) -> Array | float:
        """The factor [] of the learning rates now."""
        return decay.of_rates(self.schedule, params.decisions)

    def observed(self, state: ActorCriticState, batch: Batch) -> ActorCriticState:
        """`state` with the running statistics of the states and rewards in `batch`."""
        x, values = batch.obs, batch.reward / (1 - self.discount)
        policy = self.policy.observe(state.policy, x)
        return state.replace(policy=policy, critic=self.critic.observe(state.critic, x, values))

    def critic_step(
        self,
        state: ActorCriticState,
        rate: Array | float,
        x: Array,
        u: Array,
        y: Array,
        weight: Array | None = None,
    ) -> tuple[ActorCriticState, tuple[Array, Array]]:
        """`state` after a step of the critic to targets y [B] at x [B, n], u [B, m]; loss, mean Q.

        weight: [B] of each target; None: 1.
        """

        def loss(critic: Any) -> tuple[Array, Array]:
            q = self.critic.all(critic, x, u)
            error = (q - y[None]) ** 2
            error = error if weight is None else weight[None] * error
            return 0.5 * jnp.sum(jnp.mean(error, axis=-1)), q.mean()

        found, grads = jax.value_and_grad(loss, has_aux=True)(state.critic)
        critic, optimiser = adam_step(rate, grads, state.critic_optimiser, state.critic)
        return state.replace(critic=critic, critic_optimiser=optimiser), found

    def policy_step(
        self,
        state: ActorCriticState,
        rate: Array | float,
        loss: Callable[[Any], Any],
        limit: float | None = None,
    ) -> tuple[ActorCriticState, tuple[Array, Any, Array]]:
        """`state` after a step down `loss(policy) -> (value [], more)`; value, more, slope's norm.

        limit: of the norm; None: none.
        """
        (value, more), grads = jax.value_and_grad(loss, has_aux=True)(state.policy)
        norm = optax.tree.norm(grads)
        if limit is not None:
            shrunk = jnp.minimum(1.0, limit / jnp.maximum(norm, 1e-12))
            grads = jax.tree.map(lambda g: g * shrunk, grads)
        policy, optimiser = adam_step(rate, grads, state.policy_optimiser, state.policy)
        return state.replace(policy=policy, policy_optimiser=optimiser), (value, more, norm)


@part
class SoftActorCritic(ActorCritic):
    """An actor-critic learner with a learned temperature alpha."""

    _: KW_ONLY
    policy_learning_rate: Positive = 3e-4
    critic_learning_rate: Positive = 3e-4
    alpha_learning_rate: NotNegative = 3e-4  # 0: alpha stays
    alpha: Positive = 1.0  # initial temperature
    target_entropy: float | None = None  # [nat]; None: -m
    during_random: bool = False  # whether it also learns while decisions are random
    max_grad_norm: Positive | None = None  # of the policy's gradient; None: no limit

    def recorded(self, state: ActorCriticState, batch: Batch, noise: Array) -> Imagined:
        """The decisions of `batch`, each followed by one of the policy, for noise [B, m]."""
        u, log_prob = self.policy.sample(state.policy, batch.next_obs, noise)
        return Imagined(
            jnp.stack([batch.obs, batch.next_obs]),
            jnp.stack([batch.action, u]),
            jnp.stack([log_prob, log_prob]),
            batch.reward[None],
            (1 - batch.terminated)[None],
        )

    def evaluated(
        self,
        state: ActorCriticState,
        paths: Imagined,
        steps: int,
        params: Params,
        largest: Array | float = jnp.inf,
    ) -> tuple[ActorCriticState, dict[str, Array]]:
        """`state` after a step of the critic to the returns y of the first `steps` decisions."""
        alpha = jnp.exp(state.log_alpha)
        last = self.critic.value(state.target, paths.x[-1], paths.u[-1])
        limit = (largest + alpha * paths.u.shape[-1]) / (1 - self.discount)
        y = jnp.clip(returns.soft(paths, alpha, self.discount, last)[1], -limit, limit)
        x, u = (each[:steps].reshape(-1, each.shape[-1]) for each in (paths.x, paths.u))
        y, reached = y[:steps].ravel(), returns.reached(paths)[:steps].ravel()
        rate = self.factor(params) * self.critic_learning_rate
        state, (loss, q) = self.critic_step(state, rate, x, u, y, reached)
        return state, {"sac/critic_loss": loss, "sac/q": q}

    def improved(
        self, state: ActorCriticState, imagine: Callable[[Any], Imagined], params: Params
    ) -> tuple[ActorCriticState, Along]:
        """`state` after a step of the policy to the soft return V_0 of its own paths."""
        alpha = jnp.exp(state.log_alpha)

        def loss(policy: Any) -> tuple[Array, Imagined]:
            paths = imagine(policy)
            last = self.critic.value(state.critic, paths.x[-1], paths.u[-1])
            return -returns.soft(paths, alpha, self.discount, last)[0].mean(), paths

        rate = self.factor(params) * self.policy_learning_rate
        state, (value, paths, norm) = self.policy_step(state, rate, loss, self.max_grad_norm)
        return state, Along(value, -paths.log_prob[0].mean(), norm, paths)

    def settled(
        self, state: ActorCriticState, along: Along, params: Params
    ) -> tuple[ActorCriticState, dict[str, Array]]:
        """`state` after a step of the temperature, and the target following; metrics."""
        aim = -along.paths.u.shape[-1] if self.target_entropy is None else self.target_entropy
        rate = self.factor(params) * self.alpha_learning_rate
        grad, optimiser = along.entropy - aim, state.alpha_optimiser
        log_alpha, optimiser = adam_step(rate, grad, optimiser, state.log_alpha)
        target = statistics.soft_target_update(state.target, state.critic, self.tau)
        metrics = {
            "sac/policy_loss": along.loss,
            "sac/entropy": along.entropy,
            "sac/gradient_norm": along.norm,
            "sac/alpha": jnp.exp(state.log_alpha),
        }
        state = state.replace(target=target, log_alpha=log_alpha, alpha_optimiser=optimiser)
        return state, metrics


def adam_step(learning_rate: Array | float, grads: Any, state: Any, params: Any) -> tuple[Any, Any]:
    """The parameters and the state of Adam after a step down `grads`."""
    change, state = optax.adam(learning_rate).update(grads, state, params)
    return optax.apply_updates(params, change), state
