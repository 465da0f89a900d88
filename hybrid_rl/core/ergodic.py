"""Ergodic measures: how far a path's time average is from a distribution.

The KL-ergodic measure:

    q(s)      = 1/n sum_t N(s; x_t, Sigma)                            Sigma-approximated average
    D(p || q) ~ sum_i p_i (log(p_i N / vol) - log q(s_i)),   s_i ~ U(S),   sum_i p_i = 1

N points in a box S of volume vol. Source: thesis Definition 3 and eq. (6.1)-(6.2), where the
weight p(s_i) assumes points drawn uniformly, and q is divided by the time.

Fourier's metric compares cosine coefficients:

    F_k(x) = prod_j cos(k_j pi (x_j - low_j) / L_j) / h_k,   h_k^2 = int F_k^2,   k in {0..K-1}^v
    c_k = mean_t F_k(x_t),   phi_k = E_p F_k,   E = sum_k Lambda_k (c_k - phi_k)^2
    Lambda_k = (1 + |k|^2)^(-(v+1)/2),   c(s) = sum_k c_k F_k(s)

K^v coefficients: the cost is exponential in v. Source: Mathew and Mezic 2011; thesis section 5.1.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array


class Points(NamedTuple):
    """The points at which p and q are compared."""

    s: Array  # [N, v]
    log_p: Array  # [N] log of weights that sum to one


def log_weights(log_p: Array, share: float) -> Array:
    """log of (1 - share) p + share / N [N]: p, normalised, mixed with the uniform weights."""
    log_p = jax.nn.log_softmax(log_p)
    if not share:
        return log_p
    return jnp.logaddexp(log_p + jnp.log1p(-share), jnp.log(share / len(log_p)))


def log_sum(s: Array, x: Array, variance: Array, counted: Array | None = None) -> Array:
    """log sum_t N(s; x_t, diag(variance)) [N] at s [N, v]; `counted` [M] selects among x [M, v]."""
    apart = (s[:, None] - x[None]) ** 2 / variance[None, None]
    log_each = -0.5 * jnp.sum(apart, -1) - 0.5 * jnp.sum(jnp.log(2 * jnp.pi * variance))
    if counted is not None:
        log_each = jnp.where(counted[None], log_each, -1e30)
    return jax.nn.logsumexp(log_each, axis=1)


def divergence(points: Points, log_q: Array, volume: float) -> Array:
    """D(p || q) [] [nat] from log q [N] at the points; where p = 0, p log p = 0."""
    p, count = jnp.exp(points.log_p), len(points.log_p)
    log_p = jnp.where(p > 0, points.log_p, 0.0)
    return jnp.sum(p * (log_p + jnp.log(count / volume) - log_q))


def mean_distance(points: Points, x: Array, variance: Array) -> Array:
    """1/2 mean_t sum_i p_i |s_i - x_t|^2 in units of the variance [v], for x [M, v]."""
    apart = (points.s[:, None] - x[None]) ** 2 / variance[None, None]
    return 0.5 * jnp.mean(jnp.exp(points.log_p) @ jnp.sum(apart, -1))


def cosines(x: Array, low: tuple[float, ...], high: tuple[float, ...], modes: int) -> Array:
    """F_k(x) [M, K^v] at x [M, v]."""
    out = jnp.ones((len(x), 1))
    k = jnp.arange(modes)
    for j, (a, b) in enumerate(zip(low, high, strict=True)):
        norm = jnp.sqrt(jnp.where(k == 0, b - a, (b - a) / 2))
        wave = jnp.cos(jnp.pi * k[None] * ((x[:, j] - a) / (b - a))[:, None]) / norm[None]
        out = (out[:, :, None] * wave[:, None, :]).reshape(len(x), -1)
    return out


def fourier_decay(size: int, modes: int) -> Array:
    """Lambda_k [K^v] for v = size."""
    k = np.indices((modes,) * size).reshape(size, -1)
    return jnp.asarray((1.0 + np.sum(k**2, 0)) ** (-(size + 1) / 2), jnp.float32)


def fourier_metric(c: Array, phi: Array, weights: Array) -> Array:
    """E [] between coefficients [K^v]."""
    return jnp.sum(weights * (c - phi) ** 2)
