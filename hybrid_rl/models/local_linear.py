"""e' = A e + B (u - u_0) around a world's equilibrium: nothing is learned.

e are the world's coordinates there; A and B are its Jacobians (thesis section 6.3, Table C.1).
The planning state is the observation x, so that this model stands in wherever another stood.
"""

from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import riccati
from hybrid_rl.types import AnalyticEnv, Spec


@dataclass(frozen=True)
class LocalLinear:
    """The world's motion to first order.

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
        a, b = riccati.around_rest(self.world)
        e = self.world.to_local(x)
        e = jnp.asarray(a, e.dtype) @ e + jnp.asarray(b, e.dtype) @ (
            u - self.world.equilibrium()[1]
        )
        return self.world.from_local(e)
