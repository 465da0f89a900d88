"""Running mean and deviation of a stream of batches, and whitening by them.

m <- m + a (mean(batch) - m),   s^2 <- (1 - a) s^2 + a var(batch) + a (1 - a) (mean(batch) - m)^2

with a = max(1 / batches, rate): exact while young, exponential after, so that a growing replay
memory stays followed.
"""

import jax.numpy as jnp
from flax import struct
from jax import Array

FLOOR = 1e-3  # smallest deviation: a constant entry stays finite


@struct.dataclass
class Running:
    """Statistics of vectors of size d, in the vectors' own units."""

    mean: Array  # [d]
    std: Array  # [d]
    count: Array  # [] batches seen


def init(size: int) -> Running:
    """Mean 0 and deviation 1 until the first batch."""
    return Running(jnp.zeros(size), jnp.ones(size), jnp.zeros(()))


def update(stats: Running, batch: Array, rate: float = 1e-3) -> Running:
    """Statistics that have seen batch [B, d] too."""
    count = stats.count + 1
    a = jnp.maximum(1 / count, rate)
    step = batch.mean(0) - stats.mean
    variance = (1 - a) * stats.std**2 + a * batch.var(0) + a * (1 - a) * step**2
    return Running(stats.mean + a * step, jnp.maximum(jnp.sqrt(variance), FLOOR), count)


def whiten(stats: Running, x: Array) -> Array:
    """(x - mean) / std for x [..., d]."""
    mean, std = (jnp.broadcast_to(part, x.shape) for part in (stats.mean, stats.std))
    return (x - mean) / std


def colour(stats: Running, x: Array) -> Array:
    """Mean + std x, the inverse of `whiten`."""
    return stats.mean + stats.std * x
