"""p(s) ~ exp(c mean_i sigma_i(s)): where a learned model is unsure (thesis eq. 6.23).

sigma is a vector there; its mean over the entries, in running deviations of their change, makes it
the number that the exponent needs. What is not searched is as at the world's equilibrium.
"""

from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import riccati
from hybrid_rl.types import AnalyticEnv, Params


@dataclass(frozen=True)
class ModelUncertainty:
    """Where the next state is not known.

    Raises:
        ValueError: for a world that is no formula, or a constant that is not positive.
    """

    model: Any  # offers `deviation`
    world: AnalyticEnv
    coordinates: tuple[int, ...] = (0,)  # of the observation, [v]
    sharpness: float = 10.0  # c

    def __post_init__(self) -> None:
        """Check the fields."""
        riccati.check("target", self.world)
        object.__setattr__(self, "coordinates", tuple(self.coordinates))
        if not self.sharpness > 0:
            raise ValueError(f"target.sharpness={self.sharpness}: must be above 0")

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at s [v], up to a constant."""
        x = self.world.equilibrium()[0].astype(s.dtype).at[jnp.array(self.coordinates)].set(s)
        return self.sharpness * jnp.mean(self.model.std(params.model, x))
