"""Learn the model f and, if there is one, the reward r (thesis appendix B).

    loss = -log N(x'; x + f(x, u), s^2) + 0.5 (r + c (1 - end) r(x', u') - r(x, u))^2

with u' the action that was executed at x', no gradient through the target, and one Adam for both.
`reward_discount` c = 0 makes r a reward; c = 0.95 makes it the thesis' value-like utility, which
the planner then sums a second time. Where an episode ended, also by its time limit, no action was
executed at x', so that the target is only the reward. Without a reward the loss is that of thesis
eq. (6.24)-(6.25).

The decay of weights is AdamW's (Loshchilov and Hutter 2019).
"""

from typing import Annotated, Any, ClassVar, cast

import jax
import optax
from flax import struct
from jax import Array

from hybrid_rl.core import decay
from hybrid_rl.core.decay import adamw
from hybrid_rl.core.lifting import lifted_batch, lifted_spec
from hybrid_rl.fields import Count, Discount, NotNegative, Positive, has, part
from hybrid_rl.protocols import Reward, Schedule, Trainable
from hybrid_rl.types import Batch, Params, Spec

KNOWN = "has no weights to learn; give model_learner.reward=null"


@struct.dataclass
class ModelState:
    """The state of the model learner."""

    model: Any
    reward: Any  # None without a reward
    optimiser: Any


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
    schedule: Schedule | None = None  # of the learning rates

    data: ClassVar[str] = "uniform"
    during_random: ClassVar[bool] = True  # random decisions inform the model

    def __post_init__(self) -> None:
        if self.reward_discount and getattr(self.reward, "next_state", False):
            raise ValueError(
                "reward_model.next_state=true: the value of x' would need the state after it; give "
                "model_learner.reward_discount=0"
            )

    @property
    def owns(self) -> tuple[str, ...]:
        """The fields of `Params` that it learns."""
        return ("model",) if self.reward is None else ("model", "reward")

    @property
    def batches(self) -> int:
        """One for each member of an ensemble."""
        return self.model.members

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
        return ModelState(model, reward, optimiser)

    def params(self, state: ModelState) -> dict[str, Any]:
        """The model, and the reward if there is one."""
        return {name: getattr(state, name) for name in self.owns}

    def update(
        self, state: ModelState, params: Params, batch: Batch, key: Array
    ) -> tuple[ModelState, dict[str, Array]]:
        """One Adam step: the model's loss on all batches, the reward's on the first."""
        model = self.model.observe(state.model, batch.obs, batch.next_obs)
        reward, reward_loss = self._reward(state.reward, model, batch)

        def loss(weights: tuple[Any, Any]) -> tuple[Array, tuple[Array, Array | None]]:
            f, r = weights
            tuned = {**model, "weights": f}
            of_model = self.model.loss(tuned, batch.obs, batch.action, batch.next_obs, key)
            if reward_loss is None:
                return of_model, (of_model, None)
            of_reward = reward_loss(r, tuned)
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
        return ModelState({**model, "weights": f}, reward, optimiser), metrics

    def _reward(self, reward: Any, model: Any, batch: Batch) -> tuple[Any, Any]:
        """The reward's parameters with updated statistics, and its loss as a function.

        The function gets the model, too: its lift may have weights, which a reward teaches.
        """
        part = cast(Any, self.reward)
        if part is None:
            return None, None
        observed: Any = jax.tree.map(lambda x: x[: self.batch_size], batch)
        first = lifted_batch(self.model, model, observed)
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

        def loss(weights: Any, model: Any) -> Array:
            each = jax.vmap(part.loss, (None, 0, 0, 0, 0, 0))
            x = jax.vmap(self.model.lift, (None, 0))(model, observed.obs)
            tuned, known = {**reward, "weights": weights}, (x, first.action, first.next_obs)
            return each(tuned, *known, target, first.terminated).mean()

        return reward, loss


def _weights(model: Any, reward: Any) -> tuple[Any, Any]:
    """The weights that gradient steps change."""
    return model["weights"], None if reward is None else reward["weights"]
