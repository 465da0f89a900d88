"""r = -|q - q*| - w |e| - c |u|^2: push an object to another position than the task's target.

q is the object's position seen from the task's target, e that seen from the hand [m].
"""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.returns import quantities
from hybrid_rl.fields import NotNegative, part
from hybrid_rl.protocols import Measured


@part
class Push:
    """The quantities `block` and `reach` of `world`."""

    world: Measured
    target: tuple[float, ...] = (0.1, 0.0)  # q* [m]
    reach: NotNegative = 0.8  # w
    effort: NotNegative = 0.01  # c, of actions in [-1, 1]

    def __post_init__(self) -> None:
        quantities(self, "block", "reach")

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [m], which led to the observation `after` [o]."""
        q = self.world.quantities(after)
        away = q["block"] - jnp.asarray(self.target)
        cost = sum(
            weight * jnp.sqrt(jnp.sum(error**2) + 1e-12)  # whose gradient at 0 is finite
            for weight, error in ((1.0, away), (self.reach, q["reach"]))
        )
        return -cost - self.effort * jnp.sum(u**2)
