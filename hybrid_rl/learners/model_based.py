"""A policy and a critic that learn through a model, by gradients through imagined decisions.

From each of B start states the policy makes H decisions in the model,

    u_t ~ pi(x_t),   x_{t+1} ~ f(x_t, u_t),   r_t, c_t = reward(x_t, u_t, x_{t+1})

with c_t the chance that the episode continues. The policy maximises their soft return V_0; the
critic learns the y_t of the first `value_steps` of the same decisions (`core.soft_return`); with
none of them, from one decision, as in SAC. The start states are those of branches that go on from
one update to the next (`core.branches`), or of the replay memory. Sources: stochastic value
gradients (Heess et al. 2015), MAAC (Clavera et al. 2020), model-based value expansion (Feinberg et
al. 2018), MBPO (Janner et al. 2019).
"""

from typing import Any, ClassVar

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.core import branches, decay, soft_return
from hybrid_rl.core import soft_actor_critic as steps
from hybrid_rl.core.branches import Branches
from hybrid_rl.core.soft_actor_critic import SACState
from hybrid_rl.fields import (
    Count,
    Discount,
    FieldError,
    Natural,
    NotNegative,
    Positive,
    Share,
    part,
)
from hybrid_rl.protocols import Critic, LearnedPolicy, Reward, Schedule, Trainable
from hybrid_rl.types import Batch, Imagined, Params, Spec


@struct.dataclass
class ModelBasedState:
    """The actor and critic, and the branches."""

    learner: SACState
    branches: Branches | None  # None: none are kept


@part
class ModelBased:
    """Soft actor-critic whose policy, and critic, learn from `steps` decisions in a model."""

    policy: LearnedPolicy
    critic: Critic
    model: Trainable
    reward: Reward
    steps: Natural = 5  # H; 0: the policy maximises the critic at the start states, as in SAC
    value_steps: int | None = None  # of the H decisions, at whose states the critic learns; None: H
    branch_steps: Natural = 20  # longest branch [decisions]; 0: starts at the states of the batch
    branch_margin: Positive | None = None  # ranges beyond real states where one ends; None: none
    branch_memory: int = 25_600  # imagined transitions that are kept; 0: drawn for each update
    policy_learning_rate: Positive = 3e-4
    critic_learning_rate: Positive = 3e-4
    alpha_learning_rate: NotNegative = 3e-4  # 0: alpha stays
    alpha: Positive = 0.1  # initial temperature
    target_entropy: float | None = None  # [nat]; None: -m
    discount: Discount = 0.995
    tau: Share = 0.005
    batch_size: Count = 256
    updates: float = 2  # per decision
    during_random: bool = True  # whether it also learns while decisions are random
    max_grad_norm: Positive | None = 10.0  # of the policy's gradient; None: no limit
    schedule: Schedule | None = None  # of the learning rates

    data: ClassVar[str] = "uniform"
    owns: ClassVar[tuple[str, ...]] = ("policy", "critic")
    batches: ClassVar[int] = 1

    def __post_init__(self) -> None:
        if self.value_steps is not None and not 0 <= self.value_steps <= self.steps:
            words = f"must be a whole number from 0 to steps={self.steps}, or null for all"
            raise FieldError(self, "value_steps", words)
        if self.branch_memory % self.batch_size:
            words = f"must be 0 or a multiple of the batch, {self.batch_size}"
            raise FieldError(self, "branch_memory", words)
        if self.branch_margin is not None and not (self.branch_steps and self.branch_memory):
            words = "needs kept branches: branch_steps and branch_memory above 0"
            raise FieldError(self, "branch_margin", words)

    @property
    def _value_steps(self) -> int:
        """Imagined decisions at whose states the critic learns."""
        return self.steps if self.value_steps is None else self.value_steps

    def init(self, key: Array, spec: Spec) -> ModelBasedState:
        """Initial parameters, without branches. The key is consumed."""
        learner, kept = steps.init(self, key, spec), None
        if self.branch_steps and self.branch_memory:
            sizes = self.batch_size, self.branch_memory, spec.n, spec.act
            kept = branches.begin(*sizes, self.branch_steps)
        return ModelBasedState(learner, kept)

    def having(self, state: ModelBasedState, policy: Any) -> ModelBasedState:
        """`state` with these parameters of its policy."""
        return state.replace(learner=state.learner.replace(policy=policy))

    def params(self, state: ModelBasedState) -> dict[str, Any]:
        """The policy and the critic."""
        return {"policy": state.learner.policy, "critic": state.learner.critic}

    def update(
        self, state: ModelBasedState, params: Params, batch: Batch, key: Array
    ) -> tuple[ModelBasedState, dict[str, Array]]:
        """One step of critic, policy, temperature and target. The key is consumed."""
        kept, batch, key = self._started(state.branches, params, batch, key)
        learner, alpha = state.learner, jnp.exp(state.learner.log_alpha)
        factor = decay.of_rates(self.schedule, params.decisions)
        learner = steps.observed(self, learner, batch)
        acting, ahead = jax.random.split(key)
        noise = jax.random.normal(acting, (2, *batch.action.shape))
        of_critic = None
        if not self._value_steps:
            y = steps.target(self, learner, alpha, batch, noise[0])
            learner, of_critic = steps.critic_step(
                self, learner, batch.obs, batch.action, y, factor=factor
            )

        def loss(policy: Any) -> tuple[Array, tuple[Array, Any]]:
            if not self.steps:
                v, log_prob = self.policy.sample(policy, batch.obs, noise[1])
                value = self.critic.value(learner.critic, batch.obs, v) - alpha * log_prob
                return -value.mean(), (log_prob, None)
            paths = self.imagine(params._replace(policy=policy), batch, ahead)
            last = self.critic.value(learner.critic, paths.x[-1], paths.u[-1])
            y = soft_return.returns(paths, alpha, self.discount, last)
            return -(y[0] - alpha * paths.log_prob[0]).mean(), (paths.log_prob[0], paths)

        learner, (policy_loss, (log_prob, paths), norm) = steps.policy_step(
            self, learner, loss, self.max_grad_norm, factor
        )
        if of_critic is None:
            learner, of_critic = self._expanded(learner, alpha, paths, factor)
        entropy = -log_prob.mean()
        actions = batch.action.shape[-1]
        learner = steps.temperature_and_target(self, learner, entropy, actions, factor)
        return ModelBasedState(learner, kept), {
            "sac/critic_loss": of_critic[0],
            "sac/q": of_critic[1],
            "sac/policy_loss": policy_loss,
            "sac/entropy": entropy,
            "sac/gradient_norm": norm,
            "sac/alpha": alpha,
        }

    def _started(
        self, kept: Branches | None, params: Params, batch: Batch, key: Array
    ) -> tuple[Branches | None, Batch, Array]:
        """The branches, a batch of imagined transitions from the start states, and a new key."""
        if not self.branch_steps:
            return kept, batch, key
        drawing, key = jax.random.split(key)
        step = branches.transitions(params, self.policy, self.model, self.reward)
        m = batch.action.shape[-1]
        if kept is None:
            return None, branches.sample_fresh(step, batch.obs, m, self.branch_steps, drawing), key
        extending, recalling = jax.random.split(drawing)
        kept = branches.extended(
            kept, step, batch.obs, m, self.branch_steps, extending, self.branch_margin
        )
        return kept, branches.sample_kept(kept, m, recalling), key

    def imagine(self, params: Params, batch: Batch, key: Array) -> Imagined:
        """`steps` decisions from the states [B, n] of `batch`. The key is consumed.

        Differentiable by `params.policy`, with the noise fixed (reparameterisation).
        """
        acting, moving, choosing = jax.random.split(key, 3)
        length, x = self.steps, batch.obs
        for_policy = jax.random.normal(acting, (length + 1, *batch.action.shape))
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
            continues=jax.nn.sigmoid(-ends),
        )

    def _expanded(
        self, state: SACState, alpha: Array, paths: Imagined, factor: Array | float
    ) -> tuple:
        """`state` after a step of the critic towards returns along `paths`; its loss and mean Q."""
        paths = jax.lax.stop_gradient(paths)
        last = self.critic.value(state.target, paths.x[-1], paths.u[-1])
        y = soft_return.returns(paths, alpha, self.discount, last)
        first = slice(self._value_steps)
        x, u = (each[first].reshape(-1, each.shape[-1]) for each in (paths.x, paths.u))
        y, reached = y[first].ravel(), soft_return.reached(paths)[first].ravel()
        return steps.critic_step(self, state, x, u, y, reached, factor)
