"""r = b - |q(x') - q*| - c |u|^2: hold a quantity of the environment at a target.

q is a quantity of the environment, such as the speed of a robot, and q* its target, a number or one
for each of its entries. b is that of core.returns.
"""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.returns import bonus, quantities
from hybrid_rl.fields import NotNegative, part
from hybrid_rl.protocols import Measured


@part
class Aim:
    """A quantity of `world` at its target."""

    world: Measured
    quantity: str = "speed"
    target: tuple[float, ...] | float = 1.0  # q*, in the quantity's unit
    effort: NotNegative = 0.05  # c, of actions in [-1, 1]

    def __post_init__(self) -> None:
        quantities(self, self.quantity)

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [m], which led to the observation `after` [o]."""
        q = self.world.quantities(after)[self.quantity]
        error = q - jnp.asarray(self.target).reshape(q.shape)
        away = jnp.sqrt(jnp.sum(error**2) + 1e-12)  # whose gradient at 0 is finite
        return bonus(self.world) - away - self.effort * jnp.sum(u**2)
