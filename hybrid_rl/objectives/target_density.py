"""J = mean_t log p(s_t) - b outside: gradient ascent on the target.

A baseline of ergodic exploration, which ends at the nearest peak (thesis section 6.3.1, direct
maximisation of the acquisition function).
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.domain import Box
from hybrid_rl.fields import NotNegative, part
from hybrid_rl.protocols import Target
from hybrid_rl.types import Params, Path, Return, Spec


@part
class TargetDensity:
    """The target's mean log-density along the path."""

    target: Target
    domain: Box
    barrier: NotNegative = 0.0  # b, cost of leaving the domain, in its sides

    def init(self, spec: Spec) -> tuple[()]:
        """No memory."""
        return ()

    def prepare(
        self, params: Params, memory: tuple[()], x: Array, u_before: Array, key: Array
    ) -> tuple[Return, tuple[()]]:
        """J of a path; the key is not used."""

        def value(path: Path) -> Array:
            s = self.domain.of(path.x)
            height = jnp.mean(jax.vmap(self.target.log_density, (None, 0))(params, s))
            return height - self.barrier * self.domain.outside(s)

        return value, memory
