"""A box in some coordinates of a state: the region that a method explores."""

from dataclasses import dataclass
from math import prod

import jax
import jax.numpy as jnp
from jax import Array


@dataclass(frozen=True)
class Box:
    """The points s [v] with low <= s <= high, where s are `coordinates` of a state x [n].

    Raises:
        ValueError: for lists of different lengths, or a box without volume.
    """

    coordinates: tuple[int, ...] = (0,)  # of x
    low: tuple[float, ...] = (-1.0,)  # in units of x
    high: tuple[float, ...] = (1.0,)

    def __post_init__(self) -> None:
        """Check the fields."""
        for name in ("coordinates", "low", "high"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        if not len(self.coordinates) == len(self.low) == len(self.high) or not self.coordinates:
            raise ValueError("domain: coordinates, low and high must have one length, 1 or more")
        if not all(a < b for a, b in zip(self.low, self.high, strict=True)):
            low, high = list(self.low), list(self.high)
            raise ValueError(f"domain.low={low}: must lie below domain.high={high}")

    @property
    def size(self) -> int:
        """The number of coordinates, v."""
        return len(self.coordinates)

    @property
    def volume(self) -> float:
        """The product of its sides."""
        return prod(b - a for a, b in zip(self.low, self.high, strict=True))

    def of(self, x: Array) -> Array:
        """The coordinates s [..., v] of states x [..., n]."""
        return x[..., jnp.array(self.coordinates)]

    def put(self, x: Array, s: Array) -> Array:
        """State x [n] with its coordinates replaced by s [v]."""
        return x.at[jnp.array(self.coordinates)].set(s)

    def sample(self, count: int, key: Array) -> Array:
        """Points [count, v], uniform in the box. The key is consumed."""
        shape, low, high = (count, self.size), jnp.array(self.low), jnp.array(self.high)
        return jax.random.uniform(key, shape, minval=low, maxval=high)

    def outside(self, s: Array) -> Array:
        """Mean [] over s [M, v] of the squared distance to the box."""
        over = jnp.maximum(s - jnp.array(self.high)[None], 0)
        under = jnp.maximum(jnp.array(self.low)[None] - s, 0)
        return jnp.mean(jnp.sum((over + under) ** 2, -1))
