"""r = b + d v - c |u|^2 - p [|pitch| > level]: run forward or back, level or thriftily.

v is the speed [m/s] of the robot, d its direction. Planners see a sigmoid instead of the
indicator, as some take gradients. b is that of core.returns.
"""

from collections.abc import Callable

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.returns import bonus, quantities
from hybrid_rl.fields import NotNegative, Positive, part
from hybrid_rl.protocols import Measured

WIDTH = 0.04  # [rad] of the sigmoid


@part
class Run:
    """The speed of `world`."""

    world: Measured
    direction: float = 1.0  # d; -1: backwards
    effort: NotNegative = 0.1  # c, of actions in [-1, 1]
    level: Positive | None = None  # [rad] the largest pitch; None: any
    price: NotNegative = 10.0  # p, of a decision with a larger pitch

    def __post_init__(self) -> None:
        quantities(self, "speed", *([] if self.level is None else ["pitch"]))

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [m], which led to the observation `after` [o]."""
        return self._paid(u, after, lambda beyond: beyond > 0)

    def smoothed(self, x: Array, u: Array, after: Array) -> Array:
        """The same with a sigmoid, whose gradient is not zero."""
        return self._paid(u, after, lambda beyond: jax.nn.sigmoid(beyond / WIDTH))

    def _paid(self, u: Array, after: Array, indicator: Callable[[Array], Array]) -> Array:
        """The reward []; indicator: of the pitch [rad] beyond the level."""
        q = self.world.quantities(after)
        reward = bonus(self.world) + self.direction * q["speed"] - self.effort * jnp.sum(u**2)
        if self.level is None:
            return reward
        return reward - self.price * indicator(jnp.abs(q["pitch"]) - self.level)
