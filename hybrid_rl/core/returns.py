"""The rewards from each decision to the end of a path.

S_t = r_t + c_t S_{t+1},   S_T = the value of the last state
"""

import jax
import jax.numpy as jnp
from jax import Array


def to_go(rewards: Array, goes_on: Array, last: Array, unroll: bool = False) -> Array:
    """S [T+1] for rewards [T], discounts c = goes_on [T] and the value `last` [] at the end."""

    def back(after: Array, at: tuple[Array, Array]) -> tuple[Array, Array]:
        r, c = at
        now = r + c * after
        return now, now

    S = jax.lax.scan(back, last, (rewards, goes_on), reverse=True, unroll=unroll)[1]
    return jnp.append(S, last)
