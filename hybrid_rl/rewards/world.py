"""r(x, u, x') is what the environment pays at its next state, for paths of its own states."""

from dataclasses import dataclass

import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import EnvState, Params


@dataclass(frozen=True)
class WorldReward:
    """The reward that the world pays, for paths of its own states; nothing after an episode."""

    ends: bool = True  # also where episodes end

    def outcome(
        self, params: Params, x: EnvState, u: Array, after: EnvState
    ) -> tuple[Array, Array]:
        """The reward [] of u [m] at x, and the logit [] of the episode ending there."""
        reward = jnp.where(x.done, 0.0, after.reward)
        return reward, jnp.where(self.ends & after.terminated, jnp.inf, -jnp.inf)
