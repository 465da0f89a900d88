"""x' = f(x, u) of an analytic environment: nothing is learned."""

from dataclasses import dataclass
from typing import Any

from jax import Array

from hybrid_rl.core import analytic
from hybrid_rl.protocols import AnalyticEnv
from hybrid_rl.types import Spec


@dataclass(frozen=True)
class Exact:
    """The environment's own dynamics; the planning state is the observation.

    Raises:
        ValueError: for an environment that is not analytic.
    """

    world: AnalyticEnv

    def __post_init__(self) -> None:
        """Check the environment."""
        analytic.require("model", self.world)

    def init(self, key: Array, spec: Spec) -> tuple[()]:
        """No parameters."""
        return ()

    def lift(self, params: Any, obs: Array) -> Array:
        """The observation [o] itself."""
        return obs

    def step(self, params: Any, x: Array, u: Array) -> Array:
        """The next observation [o]."""
        return self.world.dynamics(x, u)
