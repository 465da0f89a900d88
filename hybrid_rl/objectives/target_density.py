"""J = mean_t log p(s_t) - b outside: go where the target is high, by its slope alone.

What indirect, ergodic exploration is compared with: it settles on the nearest peak
(thesis section 6.3.1, direct maximisation of the acquisition).
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import ergodic
from hybrid_rl.types import Params, Path, Spec, Target


@dataclass(frozen=True)
class TargetDensity:
    """The target's mean log-density along the path.

    Raises:
        ValueError: for a box that is none.
    """

    target: Target
    coordinates: tuple[int, ...] = (0,)  # of the planning state, [v]
    low: tuple[float, ...] = (-1.0,)
    high: tuple[float, ...] = (1.0,)
    barrier: float = 0.0  # b [1/length^2]

    def __post_init__(self) -> None:
        """Check the fields."""
        for name in ("coordinates", "low", "high"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        ergodic.box("climb", self.coordinates, self.low, self.high)

    def begin(self, spec: Spec) -> tuple[()]:
        """Nothing is remembered."""
        return ()

    def look(self, params: Params, memory: tuple[()], x: Array, key: Array) -> tuple[()]:
        """Nothing is drawn."""
        return memory

    def value(self, params: Params, memory: tuple[()], path: Path) -> Array:
        """J []."""
        s = path.x[:, jnp.array(self.coordinates)]
        height = jnp.mean(jax.vmap(self.target.log_density, (None, 0))(params, s))
        return height - self.barrier * ergodic.outside(s, self.low, self.high)
