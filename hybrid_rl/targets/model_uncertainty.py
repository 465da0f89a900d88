"""p(s) ~ exp(c mean_i sigma_i(s)): the predictive std of a learned model (thesis eq. 6.23).

sigma is a vector in the thesis; here the exponent is its mean over the entries, each in running
standard deviations of its change. Coordinates that the domain lacks have their equilibrium values.
"""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.domain import Box
from hybrid_rl.fields import Positive, part
from hybrid_rl.protocols import Analytic, Uncertain
from hybrid_rl.types import Params


@part
class ModelUncertainty:
    """Proportional to the exponential of the predictive standard deviation."""

    model: Uncertain
    world: Analytic
    domain: Box
    sharpness: Positive = 10.0  # c [1/std]

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at s [v], up to a constant."""
        x = self.domain.put(self.world.equilibrium()[0].astype(s.dtype), s)
        return self.sharpness * jnp.mean(self.model.std(params.model, x))
