"""p(s) ~ I(s): the information of a measurement at s about a belief (thesis section 5.3).

The belief chooses the measure. Until it is `informed`, with `wait`, p is uniform: before its first
contact a robot has nothing to localise itself by.
"""

from typing import Annotated

import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import has, part
from hybrid_rl.protocols import InformedBelief
from hybrid_rl.types import Params

FLOOR = 1e-12  # of the information


@part
class Information:
    """Proportional to the information of a measurement."""

    belief: Annotated[InformedBelief, has("information", "has no information of a measurement")]
    wait: bool = False  # uniform until the belief is informed

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at s [v], up to a constant."""
        log_p = jnp.log(jnp.maximum(self.belief.information(params.belief, s), FLOOR))
        return jnp.where(self.belief.informed(params.belief), log_p, 0.0) if self.wait else log_p
