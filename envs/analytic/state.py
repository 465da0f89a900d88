"""The state of a fully observed environment."""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import EnvState


def fully_observed(x: Array, reward: Array, terminated: Array | bool = False) -> EnvState:
    """The state of an environment whose observation is its whole state x [o]."""
    ended = jnp.asarray(terminated)
    return EnvState(x, x, reward, ended, jnp.zeros((), bool), {}, {})
