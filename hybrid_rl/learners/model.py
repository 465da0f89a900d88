"""Learn f and r from experience, jointly (thesis appendix B).

    loss = -log N(x'; x + f(x, u), s^2) + 0.5 (r + c (1 - end) r(x', u') - r(x, u))^2

with u' the action that was executed at x' and no gradient through the target; one Adam for both.
`reward_discount` c is 0.95 in the thesis, 0 makes r the reward itself. Where an episode ended, at
its time limit too, no action was executed at x', so that the target is the reward alone.
"""

from dataclasses import dataclass
from typing import Any

import jax
import optax
from flax import struct
from jax import Array

from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class ModelState:
    """What the model learner carries."""

    model: Any
    reward: Any
    optimiser: Any


@dataclass(frozen=True)
class ModelLearner:
    """Gradient steps on a model and a reward that offer `observe`, `loss` and "weights".

    Raises:
        ValueError: for counts, rates or a discount out of range.
    """

    model: Any
    reward: Any
    learning_rate: float = 3e-3
    batch_size: int = 128
    updates: float = 2  # per decision
    reward_discount: float = 0.0
    max_grad_norm: float | None = None

    early = True  # random decisions inform the model

    def __post_init__(self) -> None:
        """Check the fields."""
        if not 0 <= self.reward_discount < 1:
            raise ValueError(
                f"model_learner.reward_discount={self.reward_discount}: must lie in [0, 1)"
            )
        if self.learning_rate <= 0:
            raise ValueError(f"model_learner.learning_rate={self.learning_rate}: must be above 0")

    @property
    def batches(self) -> int:
        """One for each member of an ensemble."""
        return self.model.members

    def _optimiser(self) -> optax.GradientTransformation:
        adam = optax.adam(self.learning_rate)
        if self.max_grad_norm is None:
            return adam
        return optax.chain(optax.clip_by_global_norm(self.max_grad_norm), adam)

    def init(self, key: Array, spec: Spec) -> ModelState:
        """First parameters and optimiser. The key is consumed."""
        of_model, of_reward = jax.random.split(key)
        model, reward = self.model.init(of_model, spec), self.reward.init(of_reward, spec)
        weights = (model["weights"], reward["weights"])
        return ModelState(model, reward, self._optimiser().init(weights))

    def params(self, state: ModelState) -> dict[str, Any]:
        """The model and the reward."""
        return {"model": state.model, "reward": state.reward}

    def update(
        self, state: ModelState, params: Params, batch: Batch, key: Array
    ) -> tuple[ModelState, dict[str, Array]]:
        """One Adam step on both losses: the model's on all batches, the reward's on the first."""
        model = self.model.observe(state.model, batch.obs, batch.next_obs)
        first = jax.tree.map(lambda rows: rows[: self.batch_size], batch)
        reward = self.reward.observe(state.reward, first.obs)
        target = first.reward
        if self.reward_discount > 0:
            rate = jax.vmap(self.reward.reward, (None, 0, 0))
            after = rate(reward, first.next_obs, first.next_action)
            goes_on = self.reward_discount * (1 - first.terminated) * (1 - first.truncated)
            target = target + goes_on * after

        def loss(weights: tuple[Any, Any]) -> tuple[Array, tuple[Array, Array]]:
            f, r = weights
            known = {**model, "weights": f}
            of_model = self.model.loss(known, batch.obs, batch.action, batch.next_obs)
            errors = jax.vmap(self.reward.loss, (None, 0, 0, 0, 0))
            known = {**reward, "weights": r}
            of_reward = errors(known, first.obs, first.action, target, first.terminated).mean()
            return of_model + of_reward, (of_model, of_reward)

        weights = (model["weights"], reward["weights"])
        grads, (of_model, of_reward) = jax.grad(loss, has_aux=True)(weights)
        change, optimiser = self._optimiser().update(grads, state.optimiser, weights)
        new: Any = optax.apply_updates(weights, change)
        f, r = new
        state = ModelState({**model, "weights": f}, {**reward, "weights": r}, optimiser)
        return state, {"model/loss": of_model, "model/reward_loss": of_reward}
