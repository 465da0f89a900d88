"""Pairs of entries that stay on a circle, as the sine and cosine of an angle: o_i^2 + o_j^2 = r^2.

A model does not know of them: along imagined decisions the radius drifts, to where nothing real is.
A pair is on a circle if, over LEAST batches or more, the sum of its squares is constant to 0.1%,
while each square alone varies by 1% or more.
"""

import jax.numpy as jnp
from flax import struct
from jax import Array

CONSTANT, VARIES = 1e-3, 1e-2  # standard deviations, in the mean of the sum
LEAST = 100  # the first ones are of a few states, where a sum may be constant by chance


@struct.dataclass
class Circles:
    """Running statistics of squares, and the circles that they show."""

    mean: Array  # [n] of the squares
    covariance: Array  # [n, n] of the squares
    count: Array  # [] batches seen
    partner: Array  # [n] the other entry of the pair
    radius: Array  # [n] 0: on no circle


def init(size: int) -> Circles:
    """No circle."""
    zeros = jnp.zeros(size)
    none = jnp.arange(size, dtype=jnp.int32)
    return Circles(zeros, jnp.zeros((size, size)), jnp.zeros(()), none, zeros)


def update(circles: Circles, obs: Array) -> Circles:
    """Statistics that include observations [B, n], averaged over all batches, and their circles."""
    squares, count = jnp.square(obs), circles.count + 1
    of_batch, a = squares.mean(0), 1 / count
    beyond, step = squares - of_batch[None], of_batch - circles.mean
    spread = jnp.matmul(beyond.T, beyond, precision="highest") / len(obs)
    mean = circles.mean + a * step
    between = a * (1 - a) * jnp.outer(step, step)
    covariance = (1 - a) * circles.covariance + a * spread + between
    own = jnp.diagonal(covariance)
    total = mean[:, None] + mean[None]
    varies = own[:, None] + own[None] + 2 * covariance
    alone = jnp.minimum(own[:, None], own[None])
    pair = (varies <= (CONSTANT * total) ** 2) & (alone >= (VARIES * total) ** 2)
    score = jnp.where(pair, varies / jnp.square(total), jnp.inf)
    partner = jnp.argmin(score, 1).astype(jnp.int32)
    each = jnp.arange(len(mean))
    on = pair[each, partner] & (partner[partner] == each) & (count >= LEAST)
    radius = jnp.where(on, jnp.sqrt(mean + mean[partner]), 0)
    return Circles(mean, covariance, count, partner, radius)


def onto(circles: Circles, x: Array) -> Array:
    """x [n] with its pairs on their circles, in the same directions."""
    length = jnp.sqrt(jnp.maximum(jnp.square(x) + jnp.square(x[circles.partner]), 1e-12))
    return jnp.where(circles.radius > 0, x * circles.radius / length, x)
