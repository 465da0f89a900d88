"""A policy and a critic that learn through a model, by gradients through imagined decisions.

From each of B start states the policy makes H decisions in the model,

    u_t ~ pi(x_t),   x_{t+1} ~ f(x_t, u_t),   r_t, c_t = reward(x_t, u_t, x_{t+1})

with c_t the chance that the episode continues. The policy maximises their soft return V_0; the
critic learns the y_t of the first `value_steps` of the same decisions (`core.returns`); with
none of them, from one decision, as in SAC. The start states are those of branches that go on from
one update to the next (`core.branches`), or of the replay memory. The rewards of the memory, not
imagined ones, scale the critic and limit y, and no entry of an imagined state changes by more than
`change_limit` times its largest change there: where a model leaves its data all would diverge.
Sources: stochastic value gradients (Heess et al. 2015), MAAC (Clavera et al. 2020), model-based
value expansion (Feinberg et al. 2018), MBPO (Janner et al. 2019).
"""

from dataclasses import KW_ONLY
from typing import Any

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.core import branches
from hybrid_rl.core.actor_critic import ActorCriticState, SoftActorCritic
from hybrid_rl.core.branches import Branches
from hybrid_rl.fields import Discount, FieldError, Natural, Positive, part
from hybrid_rl.protocols import Reward, Trainable
from hybrid_rl.types import Batch, Imagined, Params, Spec


@struct.dataclass
class ModelBasedState:
    """The actor and critic, the branches, and what bounds imagined decisions."""

    learner: ActorCriticState
    branches: Branches | None  # None: none are kept
    largest: Array  # [] absolute reward of a decision in the batches so far
    moved: Array  # [n] largest change of a state, likewise


@part
class ModelBased(SoftActorCritic):
    """Soft actor-critic whose policy, and critic, learn from `steps` decisions in a model."""

    model: Trainable
    reward: Reward
    _: KW_ONLY
    steps: Natural = 5  # H; 0: the policy maximises the critic at the start states, as in SAC
    value_steps: int | None = None  # of the H decisions, at whose states the critic learns; None: H
    branch_steps: Natural = 20  # longest branch [decisions]; 0: starts at the states of the batch
    branch_margin: Positive | None = None  # [ranges] beyond data; None: no end
    change_limit: Positive = 100.0  # of an imagined state, in largest real changes: none overflows
    branch_memory: Natural = 25_600  # imagined transitions that are kept, as whole batches;
    # fewer than one: they are drawn for each update
    alpha: Positive = 0.1  # initial temperature
    discount: Discount = 0.995
    updates: float = 2  # per decision
    during_random: bool = True
    max_grad_norm: Positive | None = 10.0

    def __post_init__(self) -> None:
        if self.value_steps is not None and not 0 <= self.value_steps <= self.steps:
            words = f"must be a whole number from 0 to steps={self.steps}, or null for all"
            raise FieldError(self, "value_steps", words)

    @property
    def _value_steps(self) -> int:
        """Imagined decisions at whose states the critic learns."""
        return self.steps if self.value_steps is None else self.value_steps

    def init(self, key: Array, spec: Spec) -> ModelBasedState:
        """Initial parameters, without branches. The key is consumed."""
        kept = None
        if self.branch_steps and self.branch_memory >= self.batch_size:
            sizes = self.batch_size, self.branch_memory, spec.n, spec.act
            kept = branches.begin(*sizes, self.branch_steps, whole=not self._value_steps)
        learner = self.begun(key, spec, self.alpha)
        return ModelBasedState(learner, kept, jnp.zeros(()), jnp.zeros(spec.n))

    def params(self, state: ModelBasedState) -> dict[str, Any]:
        """The policy and the critic."""
        return super().params(state.learner)

    def update(
        self, state: ModelBasedState, params: Params, batch: Batch, key: Array
    ) -> tuple[ModelBasedState, dict[str, Array]]:
        """One step of critic, policy, temperature and target. The key is consumed."""
        m, of_critic, paid = batch.action.shape[-1], {}, batch.reward
        largest = jnp.maximum(state.largest, jnp.abs(paid).max())
        moved = jnp.maximum(state.moved, jnp.abs(batch.next_obs - batch.obs).max(0))
        kept, batch, key = self._started(state.branches, params, batch, moved, key)
        learner = self.observed(state.learner, batch._replace(reward=paid))
        acting, ahead = jax.random.split(key)
        if not self._value_steps:  # from decisions that were made, before the policy changes
            noise = jax.random.normal(acting, (2, *batch.action.shape))[0]
            made = self.recorded(learner, batch, noise)
            learner, of_critic = self.evaluated(learner, made, 1, params, largest)

        def imagine(policy: Any) -> Imagined:
            return self.imagine(params._replace(policy=policy), batch.obs, m, ahead, moved)

        learner, along = self.improved(learner, imagine, params)
        if count := self._value_steps:
            learner, of_critic = self.evaluated(learner, along.paths, count, params, largest)
        learner, metrics = self.settled(learner, along, params)
        return ModelBasedState(learner, kept, largest, moved), of_critic | metrics

    def _started(
        self, kept: Branches | None, params: Params, batch: Batch, moved: Array, key: Array
    ) -> tuple[Branches | None, Batch, Array]:
        """The branches, a batch of imagined transitions from the start states, and a new key."""
        if not self.branch_steps:
            return kept, batch, key
        drawing, key = jax.random.split(key)
        draw = self._drawing(params, moved)
        step = branches.transitions(params, self.policy, draw, self.reward)
        given = step, batch.obs, batch.action.shape[-1], self.branch_steps
        if kept is None:
            return None, branches.sample_fresh(*given, drawing), key
        extending, recalling = jax.random.split(drawing)
        kept = branches.extended(kept, *given, extending, self.branch_margin)
        return kept, branches.sample_kept(kept, recalling), key

    def _drawing(self, params: Params, moved: Array | float) -> branches.Draw:
        """Draws of the model, limited, where the largest real change of a state is `moved` [n]."""

        def draw(x: Array, u: Array, noise: Array, key: Array) -> Array:
            after = self.model.draw(params.model, x, u, noise, key)
            most = jnp.full_like(x, self.change_limit * moved)
            return jnp.clip(after, x - most, x + most)

        return draw

    def imagine(
        self, params: Params, x: Array, m: int, key: Array, moved: Array | float = jnp.inf
    ) -> Imagined:
        """`steps` decisions, of m entries each, from the states x [B, n]. The key is consumed.

        Changes are limited where `moved` [n] is the largest real one. Differentiable by
        `params.policy`, with the noise fixed (reparameterisation).
        """
        acting, moving, choosing = jax.random.split(key, 3)
        length, draw = self.steps, self._drawing(params, moved)
        for_policy = jax.random.normal(acting, (length + 1, len(x), m))
        for_model = jax.random.normal(moving, (length, *x.shape))

        def forward(x: Array, at: Any) -> Any:
            noise, model_noise, key = at
            u, log_prob = self.policy.sample(params.policy, x, noise)
            after = draw(x, u, model_noise, key)
            return after, (x, u, log_prob, after)

        along = for_policy[:-1], for_model, jax.random.split(choosing, length)
        last, (xs, us, log_probs, after) = jax.lax.scan(forward, x, along, unroll=True)
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
