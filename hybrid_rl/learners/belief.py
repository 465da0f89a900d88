"""Measure what the world pays: y = r at s, one measurement every few decisions.

A replay memory of two decisions hands out the newest whose successor is known, so that the
belief is told of the path in order (thesis Algorithm 9, lines 15 to 20).
"""

from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import Batch, Params, Spec


@dataclass(frozen=True)
class BeliefLearner:
    """Adds (s, r) of the batch to a belief, s after the decision.

    Raises:
        ValueError: for a batch of more than one.
    """

    belief: Any
    coordinates: tuple[int, ...] = (0,)  # of the observation, [v]
    batch_size: int = 1
    updates: float = 0.05  # measurements a decision

    batches = 1
    early = False  # it waits for the end of random decisions

    def __post_init__(self) -> None:
        """Check the fields."""
        object.__setattr__(self, "coordinates", tuple(self.coordinates))
        if self.batch_size != 1:
            raise ValueError(f"belief_learner.batch_size={self.batch_size}: must be 1")

    def init(self, key: Array, spec: Spec) -> Any:
        """The belief before any measurement. The key is consumed."""
        return self.belief.init(key, spec)

    def params(self, state: Any) -> dict[str, Any]:
        """The belief."""
        return {"belief": state}

    def update(
        self, state: Any, params: Params, batch: Batch, key: Array
    ) -> tuple[Any, dict[str, Array]]:
        """One measurement."""
        s, y = batch.next_obs[0][jnp.array(self.coordinates)], batch.reward[0]
        after = self.belief.add(state, s, y)
        return after, {
            "belief/prediction_loss": self.belief.loss(state, s, y),
            "belief/best": self.belief.best(after),
            "belief/place": s[0],
            "belief/value": y,
        }
