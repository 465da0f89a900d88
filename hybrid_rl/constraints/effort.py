"""max_i |u_i| <= most: keep the largest torque, or other effort, of an action below a limit."""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Inside, NotNegative, Positive, Share, part


@part
class Effort:
    """The largest entry of an action that arrives, as a share of what the actuator can."""

    most: Share = 0.8  # of actions in [-1, 1]
    width: Positive = 0.02  # of the planner's indicator
    price: NotNegative = 10.0  # of a violated decision
    chance: Inside | None = None  # a planner's largest probability of a violation; None: any

    def excess(self, x: Array, u: Array, after: Array) -> Array:
        """How far [] the largest |u| of u [m] is above the limit, below 0 within it."""
        return jnp.abs(u).max() - self.most
