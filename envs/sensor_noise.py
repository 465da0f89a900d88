"""Gaussian noise on the observation of an environment: o = s + std N(0, I).

The key of the next noise is in `EnvState.info`, as for any memory of a task.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import EnvState

NAME = "sensor_noise"  # in `info`: the data of a key, uint32


def begin(state: EnvState, std: tuple[float, ...], key: Array, name: str = NAME) -> EnvState:
    """The first state of an episode with noise of `std` [o], or one for all entries, on its obs.

    Without noise `state` is returned unchanged. name: of the entry in `info`. The key is consumed.
    """
    return state if not any(std) else _observed(state, std, key, name)


def resume(state: EnvState, std: tuple[float, ...], before: EnvState, name: str = NAME) -> EnvState:
    """The state after `before` with new noise on its observation."""
    if not any(std):
        return state
    return _observed(state, std, jax.random.wrap_key_data(before.info[name]), name)


def _observed(state: EnvState, std: tuple[float, ...], key: Array, name: str) -> EnvState:
    now, later = jax.random.split(key)
    scale = jnp.broadcast_to(jnp.asarray(std, state.obs.dtype), state.obs.shape)
    noise = scale * jax.random.normal(now, state.obs.shape, state.obs.dtype)
    info = {**state.info, name: jax.random.key_data(later)}
    return state.replace(obs=state.obs + noise, info=info)
