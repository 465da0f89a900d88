"""Learn the model f and, if there is one, the reward r (thesis appendix B).

    loss = -log N(x'; x + f(x, u), s^2) + 0.5 (r + c (1 - end) r(x', u') - r(x, u))^2

with u' the action that was executed at x', no gradient through the target, and one Adam for both.
`reward_discount` c = 0 makes r a reward; c = 0.95 makes it the thesis' value-like utility, which
the planner then sums a second time. Where an episode ended, also by its time limit, no action was
executed at x', so that the target is only the reward. Without a reward the loss is that of thesis
eq. (6.24)-(6.25).

A share `holdout` of all decisions never enters a gradient or a statistic: those with

    mix(sum_i mix(b_i + i g)) < share 2^32

where b_i are the bits of the entries of (o, u), g = 2^32 / 1.618, and mix is the last step of
MurmurHash3 (Appleby 2011). A decision is held out or not for a whole run and after a resume, in any
order of the memory, and nothing is stored. The model's loss on them,
a running mean over the updates, is logged and ranks the members of an ensemble with elites. The
decay of weights is AdamW's (Loshchilov and Hutter 2019).
"""

from typing import Annotated, Any, ClassVar, cast

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.core import decay
from hybrid_rl.core.decay import adamw
from hybrid_rl.core.lifting import lifted_batch, lifted_spec
from hybrid_rl.fields import Count, Discount, NotNegative, Positive, has, part
from hybrid_rl.protocols import Reward, Schedule, Trainable
from hybrid_rl.types import Batch, Params, PyTree, Spec

GOLDEN = 0x9E3779B9  # 2^32 / 1.618
KNOWN = "has no weights to learn; give model_learner.reward=null"
RATE = 0.01  # of the running mean of the held-out loss, per update (our choice)


@struct.dataclass
class HeldOut:
    """The loss on held-out decisions."""

    mean: Array  # [members] running mean
    count: Array  # [] updates with held-out decisions


@struct.dataclass
class ModelState:
    """The state of the model learner."""

    model: Any
    reward: Any  # None without a reward
    optimiser: Any
    held_out: PyTree = None  # HeldOut, or None without


@part
class ModelLearner:
    """Gradient steps on a model and, unless it is None, a reward."""

    model: Annotated[
        Trainable,
        has(
            "loss",
            "has no weights to learn; choose model=gaussian or model=ensemble, or write its loss "
            "(protocols.Trainable)",
        ),
    ]
    reward: Annotated[Reward, has("init", KNOWN)] | None = None
    learning_rate: Positive = 3e-3
    batch_size: Count = 128
    updates: float = 2  # per decision
    reward_discount: Discount = 0.0
    max_grad_norm: Positive | None = None
    weight_decay: NotNegative = 0.0  # of the layers' matrices, per unit of learning rate
    holdout: Discount = 0.0  # share of the decisions
    schedule: Schedule | None = None  # of the learning rates

    data: ClassVar[str] = "uniform"
    during_random: ClassVar[bool] = True  # random decisions inform the model

    def __post_init__(self) -> None:
        if self.reward_discount and getattr(self.reward, "next_state", False):
            raise ValueError(
                "reward_model.next_state=true: the value of x' would need the state after it; give "
                "model_learner.reward_discount=0"
            )
        if self._elites is not None and not self.holdout:
            raise ValueError(
                f"model.elites={self._elites}: needs decisions that rank the members; give "
                "model_learner.holdout, such as 0.1"
            )

    @property
    def owns(self) -> tuple[str, ...]:
        """The fields of `Params` that it learns."""
        return ("model",) if self.reward is None else ("model", "reward")

    @property
    def batches(self) -> int:
        """One for each member of an ensemble."""
        return self.model.members

    @property
    def _elites(self) -> int | None:
        """Members of an ensemble that draw states, if not all do."""
        return getattr(self.model, "elites", None)

    def _optimiser(self, factor: Array | float = 1.0) -> optax.GradientTransformation:
        adam = adamw(factor * self.learning_rate, self.weight_decay)
        if self.max_grad_norm is None:
            return adam
        return optax.chain(optax.clip_by_global_norm(self.max_grad_norm), adam)

    def init(self, key: Array, spec: Spec) -> ModelState:
        """Initial parameters and optimiser. The key is consumed."""
        if self.reward is None:
            model, reward = self.model.init(key, spec), None
        else:
            for_model, for_reward = jax.random.split(key)
            model = self.model.init(for_model, spec)
            reward = cast(Any, self.reward).init(for_reward, lifted_spec(self.model, spec))
        optimiser = self._optimiser().init(_weights(model, reward))
        none = HeldOut(jnp.zeros(self.batches), jnp.zeros(())) if self.holdout else None
        return ModelState(model, reward, optimiser, none)

    def params(self, state: ModelState) -> dict[str, Any]:
        """The model, and the reward if there is one."""
        return {name: getattr(state, name) for name in self.owns}

    def update(
        self, state: ModelState, params: Params, batch: Batch, key: Array
    ) -> tuple[ModelState, dict[str, Array]]:
        """One Adam step: the model's loss on all batches, the reward's on the first."""
        whole, held = batch, None
        if state.held_out is not None:
            held = flags(batch.obs, batch.action, self.holdout)
            batch = without(batch, held)
        model = self.model.observe(state.model, batch.obs, batch.next_obs)
        reward, reward_loss = self._reward(state.reward, model, batch)

        def loss(weights: tuple[Any, Any]) -> tuple[Array, tuple[Array, Array | None]]:
            f, r = weights
            tuned = {**model, "weights": f}
            of_model = self.model.loss(tuned, batch.obs, batch.action, batch.next_obs)
            if reward_loss is None:
                return of_model, (of_model, None)
            of_reward = reward_loss(r)
            return of_model + of_reward, (of_model, of_reward)

        weights = _weights(model, reward)
        grads, (of_model, of_reward) = jax.grad(loss, has_aux=True)(weights)
        factor = decay.of_rates(self.schedule, params.decisions)
        change, optimiser = self._optimiser(factor).update(grads, state.optimiser, weights)
        updated: Any = optax.apply_updates(weights, change)
        f, r = updated
        metrics = {"model/loss": of_model}
        if of_reward is not None:
            reward, metrics["model/reward_loss"] = {**reward, "weights": r}, of_reward
        state = ModelState({**model, "weights": f}, reward, optimiser, state.held_out)
        if held is not None:
            count = max(1, round(self.holdout * len(whole.obs)))  # held out, on average
            state = self._judged(state, *only(whole, held, count))
            metrics["model/held_out_loss"] = state.held_out.mean.mean()
        return state, metrics

    def _judged(self, state: ModelState, rows: Batch, real: Array) -> ModelState:
        """The state after losses on held-out decisions `rows` [B], of which `real` [B] count."""
        part, before = self.model, state.held_out
        each = part.losses(state.model, rows.obs, rows.action, rows.next_obs)
        now = (each * real[None]).sum(1) / jnp.maximum(real.sum(), 1)
        count = before.count + real.any()
        rate = jnp.where(real.any(), jnp.maximum(1 / jnp.maximum(count, 1), RATE), 0)
        mean = before.mean + rate * (now - before.mean)
        model = state.model if self._elites is None else part.rank(state.model, mean)
        return state.replace(model=model, held_out=HeldOut(mean, count))

    def _reward(self, reward: Any, model: Any, batch: Batch) -> tuple[Any, Any]:
        """The reward's parameters with updated statistics, and its loss as a function."""
        part = cast(Any, self.reward)
        if part is None:
            return None, None
        first: Any = jax.tree.map(lambda x: x[: self.batch_size], batch)
        first = lifted_batch(self.model, jax.lax.stop_gradient(model), first)
        reward = part.observe(reward, first.obs)
        target = first.reward
        if self.reward_discount > 0:
            outcome = jax.vmap(part.outcome, (None, 0, 0, 0))
            later = outcome(
                Params(reward=reward), first.next_obs, first.next_action, first.next_obs
            )[0]
            goes_on = self.reward_discount * (1 - first.terminated) * (1 - first.truncated)
            target = target + goes_on * later
        reward = part.observe_targets(reward, target)

        def loss(weights: Any) -> Array:
            each = jax.vmap(part.loss, (None, 0, 0, 0, 0, 0))
            tuned, known = {**reward, "weights": weights}, (first.obs, first.action, first.next_obs)
            return each(tuned, *known, target, first.terminated).mean()

        return reward, loss


def _weights(model: Any, reward: Any) -> tuple[Any, Any]:
    """The weights that gradient steps change."""
    return model["weights"], None if reward is None else reward["weights"]


def flags(obs: Array, action: Array, share: float) -> Array:
    """Which decisions are held out [B], for observations [B, o] and actions [B, m]."""
    entries = jnp.concatenate([obs, action], 1).astype(jnp.float32)
    bits = jax.lax.bitcast_convert_type(entries, jnp.uint32)
    offsets = jnp.arange(bits.shape[1], dtype=jnp.uint32) * jnp.uint32(GOLDEN)
    mixed = _mix(_mix(bits + offsets[None]).sum(1, dtype=jnp.uint32))
    return mixed < jnp.uint32(round(share * (2**32 - 1)))


def without(batch: Batch, held: Array) -> Batch:
    """`batch` with each row that is held out replaced by the last row before it that is not.

    Rows before the first one that is not held out become the last one that is not. If all are
    held out, which happens with probability share^B, the last row is repeated.
    """
    index = jnp.arange(len(held))
    kept = jax.lax.cummax(jnp.where(held, -1, index))
    kept = jnp.where(kept < 0, kept[-1], kept)
    return jax.tree.map(lambda x: x[kept], batch)


def only(batch: Batch, held: Array, count: int) -> tuple[Batch, Array]:
    """The first `count` rows held out, and which of them are [count]; the others are row 0."""
    index = jnp.flatnonzero(held, size=count, fill_value=0)
    return jax.tree.map(lambda x: x[index], batch), jnp.arange(count) < held.sum()


def _mix(h: Array) -> Array:
    """MurmurHash3's finaliser of uint32 [...]."""
    h = (h ^ (h >> 16)) * jnp.uint32(0x85EBCA6B)
    h = (h ^ (h >> 13)) * jnp.uint32(0xC2B2AE35)
    return h ^ (h >> 16)
