"""x' = f(x, u) of a world that is a formula: nothing is learned."""

from dataclasses import dataclass
from typing import Any

from jax import Array

from hybrid_rl.core import riccati
from hybrid_rl.types import AnalyticEnv, Spec


@dataclass(frozen=True)
class Exact:
    """The world's own motion; the planning state is the observation.

    Raises:
        ValueError: for a world that is no formula.
    """

    world: AnalyticEnv

    def __post_init__(self) -> None:
        """Check the world."""
        riccati.check("model", self.world)

    def init(self, key: Array, spec: Spec) -> tuple[()]:
        """Nothing."""
        return ()

    def lift(self, params: Any, obs: Array) -> Array:
        """The observation [o] itself."""
        return obs

    def step(self, params: Any, x: Array, u: Array) -> Array:
        """The next observation [o]."""
        return self.world.dynamics(x, u)
