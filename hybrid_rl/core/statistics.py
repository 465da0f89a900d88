"""Running mean and standard deviation of a stream of batches, and normalisation by them.

m <- m + a (mean(batch) - m),   s^2 <- (1 - a) s^2 + a var(batch) + a (1 - a) (mean(batch) - m)^2

with a = max(1 / batches, rate): exact for the first 1 / rate batches, then exponential, so that the
statistics follow a growing replay memory.
"""

from typing import Any

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

FLOOR = 1e-6  # minimum standard deviation relative to an entry's magnitude: float32 rounds there


@struct.dataclass
class Running:
    """Statistics of vectors of size d, in the vectors' own units."""

    mean: Array  # [d]
    std: Array  # [d]
    min_std: Array  # [d] below it, a standard deviation is a rounding error
    count: Array  # [] batches seen

    @property
    def scale(self) -> Array:
        """[d] what `normalise` divides by: std, at least `min_std`, and 1 where both are zero."""
        std = jnp.maximum(self.std, self.min_std)
        return jnp.where(std > 0, std, 1)

    @property
    def magnitude(self) -> Array:
        """[d] root mean square of the entries."""
        return jnp.sqrt(self.mean**2 + self.std**2)


def init(size: int) -> Running:
    """Mean 0 and standard deviation 1 until the first batch."""
    return Running(jnp.zeros(size), jnp.ones(size), jnp.zeros(size), jnp.zeros(()))


def update(
    stats: Running, batch: Array, magnitude: Array | None = None, rate: float = 1e-3
) -> Running:
    """Statistics that include batch [B, d].

    magnitude: [d] for a batch of differences, the magnitude of the numbers that were subtracted;
    None: that of the batch's own entries.
    """
    count = stats.count + 1
    a = jnp.maximum(1 / count, rate)
    step = batch.mean(0) - stats.mean
    variance = (1 - a) * stats.std**2 + a * batch.var(0) + a * (1 - a) * step**2
    now = Running(stats.mean + a * step, jnp.sqrt(variance), stats.min_std, count)
    return now.replace(min_std=FLOOR * (now.magnitude if magnitude is None else magnitude))


def observed(params: dict[str, Any], x: Array, name: str = "state") -> dict[str, Any]:
    """`params` with x [B, d] in the running statistics `name`, if it has these."""
    return {**params, name: update(params[name], x)} if name in params else params


def soft_target_update(old: Any, new: Any, tau: float) -> Any:
    """Target parameters: (1 - tau) old + tau new, with the statistics of `new`.

    A network's inputs and outputs have the units of its statistics, so a target in older units
    would have another value for the same weights.
    """

    def one(new: Any, old: Any) -> Any:
        return new if isinstance(new, Running) else optax.incremental_update(new, old, tau)

    return jax.tree.map(one, new, old, is_leaf=lambda node: isinstance(node, Running))


def normalise(stats: Running, x: Array) -> Array:
    """(x - mean) / scale for x [..., d]."""
    mean, scale = (jnp.broadcast_to(part, x.shape) for part in (stats.mean, stats.scale))
    return (x - mean) / scale


def inputs(params: dict[str, Any], x: Array) -> Array:
    """x [..., d] normalised by the statistics `state` in params, if it has these."""
    return normalise(jax.lax.stop_gradient(params["state"]), x) if "state" in params else x


def denormalise(stats: Running, x: Array) -> Array:
    """mean + scale x, the inverse of `normalise`."""
    return stats.mean + stats.scale * x
