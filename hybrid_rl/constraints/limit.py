"""least <= q(x') <= most: keep a quantity of the environment within limits.

q is a quantity of the environment, such as the speed of a robot; of a vector each entry has limits
(a box), or its norm has.
"""

import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core.returns import quantities
from hybrid_rl.fields import FieldError, Inside, NotNegative, Positive, part
from hybrid_rl.protocols import Measured

Bound = tuple[float | None, ...] | float | None  # one for all entries, or each its own; None: none


@part
class Limit:
    """A quantity of `world` between `least` and `most`."""

    world: Measured
    quantity: str = "speed"
    most: Bound = None  # in the quantity's unit
    least: Bound = None
    norm: bool = False  # limits the norm of a vector, the absolute value of a number
    width: Positive = 0.1  # of the planner's indicator, in the quantity's unit
    price: NotNegative = 10.0  # of a violated decision
    chance: Inside | None = None  # a planner's largest probability of a violation; None: any

    def __post_init__(self) -> None:
        quantity = quantities(self, self.quantity)[self.quantity]
        size = 1 if self.norm else quantity.size
        for name in ("most", "least"):
            given = getattr(self, name)
            if isinstance(given, tuple) and len(given) not in (1, size):
                of = f"the norm of {self.quantity}" if self.norm else self.quantity
                words = f"{of} needs {size} number{'s' if size > 1 else ''}"
                raise FieldError(self, name, words)
        if not np.isfinite(np.concatenate(self._bounds())).any():
            raise FieldError(self, "most", "limits nothing; give most, least or both")

    def _bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """`least` and `most` [1 or k], infinite where there is no limit."""

        def one(bound: Bound, free: float) -> np.ndarray:
            each = bound if isinstance(bound, tuple) else (bound,)
            return np.array([free if value is None else value for value in each], np.float32)

        return one(self.least, -np.inf), one(self.most, np.inf)

    def excess(self, x: Array, u: Array, after: Array) -> Array:
        """How far [] the quantity lies outside its limits at `after`, below 0 within them.

        In the quantity's unit. The first entries of `after` [n] are the observation.
        """
        q = self.world.quantities(after[: self.world.spec.obs])[self.quantity].reshape(-1)
        if self.norm:
            q = jnp.sqrt(jnp.sum(q**2, keepdims=True) + 1e-12)  # whose gradient at 0 is finite
        least, most = self._bounds()
        return jnp.maximum(q - most, least - q).max()
