"""The dynamics x' = f(x, u) of an analytic environment: nothing is learned."""

from typing import Any

from jax import Array

from hybrid_rl.core.lifting import Known
from hybrid_rl.fields import part
from hybrid_rl.protocols import Analytic


@part
class Exact(Known):
    """The environment's own dynamics; the planning state is the observation."""

    world: Analytic

    def step(self, params: Any, x: Array, u: Array) -> Array:
        """The next observation [o]."""
        return self.world.dynamics(x, u)
