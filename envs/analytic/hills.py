"""The function on the rail [-1, 1] m whose maximum Bayesian optimisation searches.

phi(x) = sum_i h_i exp(-(x - c_i)^2 / (2 w_i^2))

Three peaks; the highest has height 1, at x = 0.65 m.
"""

import jax.numpy as jnp
from jax import Array

PEAKS = ((-0.6, 0.15, 0.6), (0.05, 0.12, 0.8), (0.65, 0.1, 1.0))  # centre [m], width [m], height


def phi(x: Array) -> Array:
    """The height [...] at x [...] [m]."""
    each = [h * jnp.exp(-0.5 * ((x - centre) / width) ** 2) for centre, width, h in PEAKS]
    return sum(each[1:], each[0])
