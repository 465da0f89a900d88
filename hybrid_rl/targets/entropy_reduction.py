"""p(s) ~ H(y | s): how much entropy a measurement at s is expected to remove from a belief.

A controller that goes to its maximum reduces the expected entropy (thesis section 5.3.1).
"""

from typing import Annotated

import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import has, part
from hybrid_rl.protocols import InformedBelief
from hybrid_rl.types import Params

FLOOR = 1e-12  # [nat]


@part
class EntropyReduction:
    """Proportional to the expected reduction of entropy."""

    belief: Annotated[InformedBelief, has("gain_along", "has no entropy of a measurement")]

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at s [v], up to a constant."""
        return jnp.log(jnp.maximum(self.belief.gain(params.belief, s), FLOOR))

    def along(self, params: Params, path: Array) -> Array:
        """The entropy [nat] [] that the expected measurements on path [T, v] remove."""
        return self.belief.gain_along(params.belief, path)
