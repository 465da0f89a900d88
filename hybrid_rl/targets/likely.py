"""p(s) ~ q(s) d(s)^power, d: the density of the states to which the clone came recently.

    d(s) = sum_j exp(-|(s - x_j) / (h scale)|^2 / 2)   over the last R states x_j

A query is of use where its answer is new (q) and where the clone comes (d). The density is a
kernel estimate (Parzen 1962); the product is ours.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.ranges import above_zero
from hybrid_rl.protocols import Target
from hybrid_rl.types import Params, PyTree


@dataclass(frozen=True)
class Likely:
    """Another target times the density of recent states, of which the learner keeps `recent`.

    Raises:
        ValueError: for a bandwidth or a power that is not positive.
    """

    target: Target
    bandwidth: float = 0.5  # h, in standard deviations of the first demonstration
    power: float = 1.0

    needs_recent: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Check the fields."""
        above_zero(self, "target", "bandwidth", "power")

    def evidence(self, params: Params, x: Array) -> PyTree:
        """What the other target sums over the labels."""
        inner: Any = self.target
        return inner.evidence(params, x) if hasattr(inner, "evidence") else None

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at the planning state s [n], up to a constant; needs params.belief."""
        scale = (self.bandwidth * params.belief.scale)[None]
        away = (params.belief.visited - s[None]) / scale
        density = jax.nn.logsumexp(-0.5 * jnp.sum(away**2, 1))
        return self.target.log_density(params, s) + self.power * density
