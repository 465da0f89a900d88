"""J = sum_i g_i (1 - prod_t (1 - k(s_i, x_t))) - b outside: the information that a path gathers.

g_i is the information at N points s_i of a lattice, normalised, and k = exp(-|s - x|^2 / (2 w^2))
the share of it that a measurement at x gathers: what one position gathered, no other counts again
(probabilistic coverage, a submodular function). Earlier positions of the episode count too,

    1 - k -> h_i (1 - k),   h_i <- (h_i (1 - k(s_i, x)))^f,

with a share f of the logarithm of h kept per decision: f = 1 never forgets, and f = 0 leaves it to
the belief to know what was measured. Source: informative path planning, Krause and Guestrin 2007,
Near-optimal Observation Selection using Submodular Functions; Singh et al. 2009.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import ergodic
from hybrid_rl.core.domain import Box
from hybrid_rl.fields import Count, Fraction, NotNegative, Positive, part
from hybrid_rl.protocols import Target
from hybrid_rl.types import Params, Path, Return, Spec


@part
class InformativePath:
    """The information, by a target, that a path gathers in a domain."""

    target: Target
    domain: Box
    samples: Count = 1000  # N
    width: Positive = 0.05  # w, as a share of the domain's sides
    forget: Fraction = 1.0  # f
    barrier: NotNegative = 0.0  # b, cost of leaving the domain, in its sides
    share: Fraction = 0.0  # of the uniform density in g; 1: coverage

    @property
    def points(self) -> Array:
        """s [N, v], the same at every decision."""
        return self.domain.sample(self.samples, jax.random.key(0))

    def init(self, spec: Spec) -> Array:
        """h [N] before any measurement."""
        return jnp.ones(self.samples)

    def prepare(
        self, params: Params, memory: Array, x: Array, u_before: Array, key: Array
    ) -> tuple[Return, Array]:
        """J of a path; the memory h [N] then includes x [n]. The key is not used."""
        log_p = jax.vmap(self.target.log_density, (None, 0))(params, self.points)
        left = jnp.exp(ergodic.log_weights(log_p, self.share)) * memory

        def value(path: Path) -> Array:
            s = self.domain.of(path.x)
            gathered = 1 - jnp.prod(1 - self.gathers(s), axis=0)
            return left @ gathered - self.barrier * self.domain.outside(s)

        now = self.gathers(self.domain.of(x)[None])[0]
        return value, (memory * (1 - now)) ** self.forget

    def gathers(self, x: Array) -> Array:
        """k [M, N] of positions x [M, v]."""
        apart = (x[:, None] - self.points[None]) / self.domain.sides[None, None]
        return jnp.exp(-0.5 * jnp.sum(apart**2, -1) / self.width**2)
