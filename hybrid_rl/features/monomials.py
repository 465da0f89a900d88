"""z = (y, 1, products of entries of y): hand-made features of an observation.

    y_i = (o_c(i) - centre_i) scale_i,   with `terms` such as (0, 1, 1) for y_0 y_1^2

Powers grow fast: scale coordinates to about 1. Source: thesis sections 7.1, 7.3 and 7.5.
"""

from typing import Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.lifting import check_coordinates, select
from hybrid_rl.fields import part
from hybrid_rl.types import Spec


@part
class Monomials:
    """Coordinates of the observation, a constant, and products of the coordinates."""

    coordinates: tuple[int, ...] | None = None  # of the observation; None: all
    scale: tuple[float, ...] = (1.0,)  # one for all coordinates, or one each
    centre: tuple[float, ...] = (0.0,)  # one for all coordinates, or one each [unit of o]
    constant: bool = False
    terms: tuple[tuple[int, ...], ...] = ()  # indices into the coordinates; repeated for powers

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """No parameters."""
        check_coordinates("features.coordinates", self.coordinates, spec.obs)
        size = spec.obs if self.coordinates is None else len(self.coordinates)
        check_coordinates("features.terms", tuple(i for term in self.terms for i in term), size)
        return {}

    def __call__(self, params: dict[str, Any], obs: Array) -> Array:
        """z [n] of an observation [o]."""
        y = select(obs, self.coordinates)
        y = (y - jnp.array(self.centre, y.dtype)) * jnp.array(self.scale, y.dtype)
        parts = [y]
        if self.constant:
            parts.append(jnp.ones(1, y.dtype))
        parts += [jnp.prod(y[jnp.array(term)])[None] for term in self.terms]
        return jnp.concatenate(parts)
