"""phi ~ GP(0, k): an exact Gaussian process over a ring of C measurements.

    k(s, s') = a^2 exp(-|s - s'|^2 / (2 l^2)),   K = k(S, S) + e^2 I = L L'
    mean(s) = k(s, S) K^-1 y,   var(s) = a^2 - |L^-1 k(S, s)|^2

Empty slots of the ring are treated as independent of everything, so that shapes stay fixed.
Source: Rasmussen and Williams 2006, algorithm 2.1; thesis section 6.3.1.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array
from jax.scipy.linalg import solve_triangular

from hybrid_rl.fields import Count, Positive, part
from hybrid_rl.types import Spec


class GPState(NamedTuple):
    """The measurements, and what predictions need."""

    s: Array  # [C, v]
    y: Array  # [C]
    count: Array  # [] measurements so far
    inverse: Array  # [C, C] L^-1
    weights: Array  # [C] K^-1 y


@part
class GaussianProcess:
    """A belief about a function of `size` variables."""

    size: Count = 1  # v
    capacity: Count = 100  # C
    length: Positive = 0.2  # l, in units of s
    signal: Positive = 0.5  # a
    noise: Positive = 0.02  # e

    def init(self, key: Array, spec: Spec) -> GPState:
        """The belief before any measurement; the key is not used."""
        c = self.capacity
        eye = jnp.eye(c) / jnp.sqrt(self.signal**2 + self.noise**2)
        none = jnp.zeros(())
        return GPState(jnp.zeros((c, self.size)), jnp.zeros(c), none, eye, jnp.zeros(c))

    def add(self, state: GPState, s: Array, y: Array, key: Array) -> GPState:
        """The belief after y [] was measured at s [v], in the oldest slot; the key is not used."""
        slot = (state.count % self.capacity).astype(jnp.int32)
        s, y, count = state.s.at[slot].set(s), state.y.at[slot].set(y), state.count + 1
        filled = jnp.arange(self.capacity) < count
        both = filled[:, None] & filled[None]
        eye = jnp.eye(self.capacity)
        K = jnp.where(both, self._kernel(s, s), self.signal**2 * eye) + self.noise**2 * eye
        inverse = solve_triangular(jnp.linalg.cholesky(K), eye, lower=True)
        return GPState(s, y, count, inverse, inverse.T @ (inverse @ jnp.where(filled, y, 0)))

    def _kernel(self, s: Array, other: Array) -> Array:
        """The kernel k [N, M] of s [N, v] and other [M, v]."""
        apart = jnp.sum((s[:, None] - other[None]) ** 2, -1)
        return self.signal**2 * jnp.exp(-0.5 * apart / self.length**2)

    def predict(self, state: GPState, s: Array) -> tuple[Array, Array]:
        """Mean and standard deviation [] of phi at s [v]."""
        k = self._kernel(s[None], state.s)[0]
        k = jnp.where(jnp.arange(self.capacity) < state.count, k, 0)
        variance = self.signal**2 - jnp.sum((state.inverse @ k) ** 2)
        return k @ state.weights, jnp.sqrt(jnp.maximum(variance, 1e-8))

    def report(self, state: GPState) -> dict[str, Array]:
        """The maximum of y [] in the ring."""
        filled = jnp.arange(self.capacity) < state.count
        return {"belief/best": jnp.max(jnp.where(filled, state.y, -jnp.inf))}

    def loss(self, state: GPState, s: Array, y: Array) -> Array:
        """-log N(y; mean, std^2 + e^2) [] at s [v], before y [] is added."""
        mean, std = self.predict(state, s)
        return -jax.scipy.stats.norm.logpdf(y, mean, jnp.sqrt(std**2 + self.noise**2))
