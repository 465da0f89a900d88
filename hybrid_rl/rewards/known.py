"""r(x, u, x') is the environment's own function of observations and action: nothing is learned.

The dynamics may be learned. A reward of your own is a class with a method `reward_of`, in place of
`world`, or one with a method `outcome`, in place of this part.
"""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import part
from hybrid_rl.protocols import Rewarded
from hybrid_rl.types import Params


@part
class KnownReward:
    """The reward of `world`, for episodes that do not end.

    Raises:
        ValueError: for an environment whose reward is not a function of observations and action.
    """

    world: Rewarded

    def outcome(self, params: Params, x: Array, u: Array, after: Array) -> tuple[Array, Array]:
        """The reward [] of u [m] at x [n], whose first entries are the observation; no end."""
        o = self.world.spec.obs
        return self.world.reward_of(x[:o], u, after[:o]), jnp.full((), -jnp.inf)
