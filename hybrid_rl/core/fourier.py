"""Fourier's ergodic metric: how far a path's cosine coefficients are from a distribution's.

    F_k(x) = prod_j cos(k_j pi (x_j - low_j) / L_j) / h_k,   h_k^2 = int F_k^2,   k in {0..K-1}^v
    c_k = mean_t F_k(x_t),   phi_k = E_p F_k,   E = sum_k Lambda_k (c_k - phi_k)^2
    Lambda_k = (1 + |k|^2)^(-(v+1)/2),   c(s) = sum_k c_k F_k(s)

K^v coefficients: the cost is exponential in v. Source: Mathew and Mezic 2011; thesis section 5.1.
"""

import jax.numpy as jnp
import numpy as np
from jax import Array


def features(x: Array, low: tuple[float, ...], high: tuple[float, ...], modes: int) -> Array:
    """F_k(x) [M, K^v] at x [M, v]."""
    out = jnp.ones((len(x), 1))
    k = jnp.arange(modes)
    for j, (a, b) in enumerate(zip(low, high, strict=True)):
        norm = jnp.sqrt(jnp.where(k == 0, b - a, (b - a) / 2))
        wave = jnp.cos(jnp.pi * k[None] * ((x[:, j] - a) / (b - a))[:, None]) / norm[None]
        out = (out[:, :, None] * wave[:, None, :]).reshape(len(x), -1)
    return out


def decay(size: int, modes: int) -> Array:
    """Lambda_k [K^v] for v = size."""
    k = np.indices((modes,) * size).reshape(size, -1)
    return jnp.asarray((1.0 + np.sum(k**2, 0)) ** (-(size + 1) / 2), jnp.float32)


def metric(c: Array, phi: Array, weights: Array) -> Array:
    """E [] between coefficients [K^v]."""
    return jnp.sum(weights * (c - phi) ** 2)
