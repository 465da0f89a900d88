"""Weighted particles: effective number, systematic resampling, means on the circle."""

import jax
import jax.numpy as jnp
from jax import Array


def effective(log_w: Array) -> Array:
    """1 / sum_i w_i^2 [] of log-weights [N], up to a constant."""
    return 1 / jnp.sum(jax.nn.softmax(log_w) ** 2)


def systematic(log_w: Array, count: int, shift: Array) -> Array:
    """Indices [count] of particles with log-weights [N], drawn with one `shift` [] in [0, 1).

    Particle i is drawn floor(count w_i) or ceil(count w_i) times (Kitagawa 1996).
    """
    total = jnp.cumsum(jax.nn.softmax(log_w))
    marks = (jnp.arange(count) + shift) / count * total[-1]
    marks = jnp.minimum(marks, jnp.nextafter(total[-1], 0.0))  # where it was rounded up to the sum
    return jnp.searchsorted(total, marks, side="right")


def circular(angle: Array, w: Array) -> tuple[Array, Array]:
    """Mean [rad] and resultant length [] of angles [N] with weights w [N] that sum to 1."""
    sin, cos = w @ jnp.sin(angle), w @ jnp.cos(angle)
    return jnp.arctan2(sin, cos), jnp.hypot(sin, cos)
