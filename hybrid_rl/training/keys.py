"""The random numbers of one decision of an agent."""

from typing import NamedTuple, Self

import jax
import jax.numpy as jnp
from jax import Array


class Keys(NamedTuple):
    """Keys for the parts of one decision."""

    next: Array  # [] of the next decision
    at_random: Array  # []
    learning: Array  # []
    deciding: Array  # [E]
    resetting: Array  # [E]

    @classmethod
    def of(cls, key: Array, num_envs: int) -> Self:
        """From the key [] of the state before the decision, which is consumed."""
        keys = jax.random.split(key, 3 + 2 * num_envs)
        return cls(*keys[:3], *jnp.split(keys[3:], 2))
