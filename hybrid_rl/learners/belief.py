"""Update a belief with measurements of the reward, y = r at s (thesis Algorithm 9, lines 15-20)."""

from typing import Any, ClassVar

import jax
from jax import Array

from hybrid_rl.core.domain import Box
from hybrid_rl.fields import Count, part
from hybrid_rl.protocols import Belief
from hybrid_rl.types import Batch, Params, Spec


@part
class BeliefLearner:
    """Adds the reward of the latest decision, measured at the state s after it, to a belief."""

    belief: Belief
    domain: Box  # s: these coordinates of the observation
    every: Count = 20  # decisions between two measurements

    data: ClassVar[str] = "latest"
    owns: ClassVar[tuple[str, ...]] = ("belief",)

    def __post_init__(self) -> None:
        size = getattr(self.belief, "size", self.domain.size)
        if size != self.domain.size:
            raise ValueError(f"belief.size={size}: must be {self.domain.size}, as of the domain")

    def init(self, key: Array, spec: Spec) -> Any:
        """The belief before any measurement. The key is consumed."""
        return self.belief.init(key, spec)

    def params(self, state: Any) -> dict[str, Any]:
        """The belief."""
        return {"belief": state}

    def update(
        self, state: Any, params: Params, batch: Batch, key: Array
    ) -> tuple[Any, dict[str, Array]]:
        """One measurement of each environment. The key is consumed."""
        s, y = self.domain.of(batch.next_obs), batch.reward

        def add(state: Any, measured: tuple[Array, ...]) -> tuple[Any, Array]:
            s, y, key = measured
            return self.belief.add(state, s, y, key), self.belief.loss(state, s, y)

        after, losses = jax.lax.scan(add, state, (s, y, jax.random.split(key, len(y))))
        return after, {
            "belief/prediction_loss": losses.mean(),
            **self.belief.report(after),
            "belief/position": s[-1, 0],
            "belief/value": y[-1],
        }
