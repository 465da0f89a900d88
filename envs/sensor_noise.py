"""Gaussian noise on the observation of an environment: o = s + std N(0, I).

The key of the next noise is in `EnvState.info`, as for any memory of a task.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import EnvState

NAME = "sensor_noise"  # in `info`: the data of a key, uint32


def begin(state: EnvState, std: tuple[float, ...], key: Array) -> EnvState:
    """The first state of an episode with noise of `std` [o], or one for all entries, on its obs.

    Without noise `state` is returned unchanged. The key is consumed.
    """
    if not any(std):
        return state
    obs, later = added(state.obs, std, key)
    return state.replace(obs=obs, info={**state.info, NAME: later})


def resume(state: EnvState, std: tuple[float, ...], before: EnvState) -> EnvState:
    """The state after `before` with new noise on its observation."""
    return begin(state, std, jax.random.wrap_key_data(before.info[NAME])) if any(std) else state


def added(obs: Array, std: tuple[float, ...], key: Array) -> tuple[Array, Array]:
    """obs [o] with noise, and the data of the next key. The key is consumed."""
    now, later = jax.random.split(key)
    scale = jnp.broadcast_to(jnp.asarray(std, obs.dtype), obs.shape)
    return obs + scale * jax.random.normal(now, obs.shape, obs.dtype), jax.random.key_data(later)
