"""x' = f(x, u) is the environment's own step: nothing is learned.

The planning state is the whole EnvState, which the planner gets in `params.world`: positions,
velocities, filters, reward. It stays the same once an episode is over. Randomness that an
environment keeps in its state, such as the noise of sensors, is that of the true future.
"""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.lifting import Known
from hybrid_rl.protocols import Env
from hybrid_rl.types import EnvState, Params


@dataclass(frozen=True)
class World(Known):
    """The task's physics, as `world` steps it, with any of its implementations."""

    world: Env

    def start(self, params: Params) -> EnvState:
        """The state of the world."""
        assert params.world is not None  # `Trained.learner` refuses a loop with observations alone
        return params.world

    def step(self, params: Any, x: Any, u: Array) -> Any:
        """The EnvState after action u [m] at the EnvState x; x itself once the episode is over."""
        if not isinstance(x, EnvState):
            line = "model=world: needs a planner that samples, such as algo=mppi has"
            raise ValueError(f"{line}; one of yours begins at lifting.start(model, params, obs)")
        after = self.world.step(x, u)
        return jax.tree.map(lambda old, new: jnp.where(x.done, old, new), x, after)
