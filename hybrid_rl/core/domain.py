"""A box in some coordinates of a state: the region that a method explores."""

from math import prod

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.fields import FieldError, check_span, part


@part
class Box:
    """The points s [v] with low <= s <= high, where s are `coordinates` of a state x [n].

    A lattice, s_i = frac(shift + i a), a_j = g^-j with g^(v+1) = g + 1, covers the box more evenly
    than independent points; each of its points is uniform, since the shift is (Roberts 2018, The
    Unreasonable Effectiveness of Quasirandom Sequences).
    """

    coordinates: tuple[int, ...] = (0,)  # of x
    low: tuple[float, ...] = (-1.0,)  # in units of x
    high: tuple[float, ...] = (1.0,)
    lattice: bool = False  # points that `sample` draws; false: independent

    def __post_init__(self) -> None:
        check_span(self)
        if len(self.coordinates) != len(self.low):
            raise FieldError(self, "coordinates", f"must be {len(self.low)}, as low and high")

    @property
    def size(self) -> int:
        """The number of coordinates, v."""
        return len(self.coordinates)

    @property
    def sides(self) -> Array:
        """Their lengths [v]."""
        return jnp.array(self.high) - jnp.array(self.low)

    @property
    def volume(self) -> float:
        """The product of its sides."""
        return prod(b - a for a, b in zip(self.low, self.high, strict=True))

    def of(self, x: Array) -> Array:
        """The coordinates s [..., v] of states x [..., n]."""
        if not all(-x.shape[-1] <= i < x.shape[-1] for i in self.coordinates):
            line = f"must be entries of a state with {x.shape[-1]}"
            raise FieldError(self, "coordinates", line)
        return x[..., jnp.array(self.coordinates)]

    def put(self, x: Array, s: Array) -> Array:
        """State x [n] with its coordinates replaced by s [v]."""
        return x.at[jnp.array(self.coordinates)].set(s)

    def sample(self, count: int, key: Array) -> Array:
        """Points [count, v], uniform in the box. The key is consumed."""
        shape, low, high = (count, self.size), jnp.array(self.low), jnp.array(self.high)
        if not self.lattice:
            return jax.random.uniform(key, shape, minval=low, maxval=high)
        root = 2.0
        for _ in range(64):
            root = (1 + root) ** (1 / (self.size + 1))
        steps = np.outer(np.arange(count), root ** -np.arange(1.0, self.size + 1)) % 1
        points = (jnp.asarray(steps, jnp.float32) + jax.random.uniform(key, (1, self.size))) % 1
        return low[None] + (high - low)[None] * points

    def outside(self, s: Array) -> Array:
        """Mean [] over s [M, v] of the squared distance to the box, in units of its sides."""
        over = jnp.maximum(s - jnp.array(self.high)[None], 0)
        under = jnp.maximum(jnp.array(self.low)[None] - s, 0)
        return jnp.mean(jnp.sum(((over + under) / self.sides[None]) ** 2, -1))
