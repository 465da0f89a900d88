"""Known dynamics near an equilibrium, e' = A e + B (u - u_0): nothing is learned.

e are the environment's local coordinates; A and B are its Jacobians (thesis section 6.3, Table
C.1). The planning state is the observation, as for the other models.
"""

from typing import Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import riccati
from hybrid_rl.core.lifting import Known
from hybrid_rl.fields import part
from hybrid_rl.protocols import Analytic


@part
class LocalLinear(Known):
    """The environment's dynamics to first order."""

    world: Analytic

    def step(self, params: Any, x: Array, u: Array) -> Array:
        """The next observation [o]."""
        a, b = riccati.at_equilibrium(self.world)
        e, hold = self.world.to_local(x), self.world.equilibrium()[1]
        e = jnp.asarray(a, e.dtype) @ e + jnp.asarray(b, e.dtype) @ (u - hold)
        return self.world.from_local(e)
