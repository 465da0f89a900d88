"""x' = f(x, u) of an analytic environment: nothing is learned."""

from typing import Any

from jax import Array

from hybrid_rl.fields import part
from hybrid_rl.protocols import Analytic
from hybrid_rl.types import Spec


@part
class Exact:
    """The environment's own dynamics; the planning state is the observation."""

    world: Analytic

    def init(self, key: Array, spec: Spec) -> tuple[()]:
        """No parameters."""
        return ()

    def lift(self, params: Any, obs: Array) -> Array:
        """The observation [o] itself."""
        return obs

    def step(self, params: Any, x: Array, u: Array) -> Array:
        """The next observation [o]."""
        return self.world.dynamics(x, u)
