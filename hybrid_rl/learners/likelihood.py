"""Learn f alone, by its likelihood (thesis eq. 6.24-6.25).

theta <- theta + a sum_k grad log N(x'; x + f(x, u), s(x)^2)
"""

from dataclasses import dataclass
from typing import Any

import jax
import optax
from flax import struct
from jax import Array

from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class LikelihoodState:
    """What it carries."""

    model: Any
    optimiser: Any


@dataclass(frozen=True)
class Likelihood:
    """Adam on a model that offers `observe`, `loss` and "weights".

    Raises:
        ValueError: for a rate that is not positive.
    """

    model: Any
    learning_rate: float = 3e-3
    batch_size: int = 128
    updates: float = 1  # per decision

    early = True  # random decisions inform the model

    def __post_init__(self) -> None:
        """Check the fields."""
        if self.learning_rate <= 0:
            raise ValueError(f"likelihood.learning_rate={self.learning_rate}: must be above 0")

    @property
    def batches(self) -> int:
        """One for each member of an ensemble."""
        return self.model.members

    def init(self, key: Array, spec: Spec) -> LikelihoodState:
        """First parameters and optimiser. The key is consumed."""
        model = self.model.init(key, spec)
        return LikelihoodState(model, optax.adam(self.learning_rate).init(model["weights"]))

    def params(self, state: LikelihoodState) -> dict[str, Any]:
        """The model."""
        return {"model": state.model}

    def update(
        self, state: LikelihoodState, params: Params, batch: Batch, key: Array
    ) -> tuple[LikelihoodState, dict[str, Array]]:
        """One step on a batch [members * B]."""
        model = self.model.observe(state.model, batch.obs, batch.next_obs)

        def loss(weights: Any) -> Array:
            known = {**model, "weights": weights}
            return self.model.loss(known, batch.obs, batch.action, batch.next_obs)

        value, grads = jax.value_and_grad(loss)(model["weights"])
        change, optimiser = optax.adam(self.learning_rate).update(grads, state.optimiser)
        weights = optax.apply_updates(model["weights"], change)
        return LikelihoodState({**model, "weights": weights}, optimiser), {"model/loss": value}
