"""phi ~ GP(0, k): an exact Gaussian process over a ring of C measurements.

    k(s, s') = a^2 exp(-|s - s'|^2 / (2 l^2)),   K = k(S, S) + e^2 I = L L'
    mean(s) = k(s, S) K^-1 y,   var(s) = a^2 - |L^-1 k(S, s)|^2

Places that are not filled yet count as independent of everything, so that all shapes stay fixed.
Source: Rasmussen and Williams 2006, algorithm 2.1; thesis section 6.3.1.
"""

from dataclasses import dataclass
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array
from jax.scipy.linalg import solve_triangular

from hybrid_rl.types import Spec


class Measured(NamedTuple):
    """What is known of phi."""

    s: Array  # [C, v]
    y: Array  # [C]
    count: Array  # [] measurements so far
    whitener: Array  # [C, C] L^-1
    weights: Array  # [C] K^-1 y


@dataclass(frozen=True)
class GaussianProcess:
    """A belief about a function of `size` variables.

    Raises:
        ValueError: for a capacity, a length or deviations that are not positive.
    """

    size: int = 1  # v
    capacity: int = 100  # C
    length: float = 0.2  # l, in units of s
    signal: float = 0.5  # a
    noise: float = 0.02  # e

    def __post_init__(self) -> None:
        """Check the fields."""
        for name in ("size", "capacity", "length", "signal", "noise"):
            if not getattr(self, name) > 0:
                raise ValueError(f"belief.{name}={getattr(self, name)}: must be above 0")

    def init(self, key: Array, spec: Spec) -> Measured:
        """Nothing measured; the key plays no part."""
        c = self.capacity
        eye = jnp.eye(c) / jnp.sqrt(self.signal**2 + self.noise**2)
        none = jnp.zeros(())
        return Measured(jnp.zeros((c, self.size)), jnp.zeros(c), none, eye, jnp.zeros(c))

    def add(self, known: Measured, s: Array, y: Array) -> Measured:
        """Known, and that phi(s) was measured as y [], at s [v]; the oldest makes room."""
        at = (known.count % self.capacity).astype(jnp.int32)
        s, y, count = known.s.at[at].set(s), known.y.at[at].set(y), known.count + 1
        filled = jnp.arange(self.capacity) < count
        both = filled[:, None] & filled[None]
        eye = jnp.eye(self.capacity)
        K = jnp.where(both, self._kernel(s, s), self.signal**2 * eye) + self.noise**2 * eye
        whitener = solve_triangular(jnp.linalg.cholesky(K), eye, lower=True)
        return Measured(s, y, count, whitener, whitener.T @ (whitener @ jnp.where(filled, y, 0)))

    def _kernel(self, s: Array, other: Array) -> Array:
        """K [N, M] of s [N, v] and other [M, v]."""
        apart = jnp.sum((s[:, None] - other[None]) ** 2, -1)
        return self.signal**2 * jnp.exp(-0.5 * apart / self.length**2)

    def predict(self, known: Measured, s: Array) -> tuple[Array, Array]:
        """Mean and standard deviation [] of phi at s [v]."""
        k = self._kernel(s[None], known.s)[0]
        k = jnp.where(jnp.arange(self.capacity) < known.count, k, 0)
        variance = self.signal**2 - jnp.sum((known.whitener @ k) ** 2)
        return k @ known.weights, jnp.sqrt(jnp.maximum(variance, 1e-8))

    def best(self, known: Measured) -> Array:
        """The greatest y [] that is remembered."""
        filled = jnp.arange(self.capacity) < known.count
        return jnp.max(jnp.where(filled, known.y, -jnp.inf))

    def loss(self, known: Measured, s: Array, y: Array) -> Array:
        """-log N(y; mean, std^2 + e^2) [] before it is measured at s [v]."""
        mean, std = self.predict(known, s)
        return -jax.scipy.stats.norm.logpdf(y, mean, jnp.sqrt(std**2 + self.noise**2))
