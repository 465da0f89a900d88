"""What worlds that are formulas share: one step of Runge and Kutta, and hills to search.

k_1 = f(x),  k_2 = f(x + k_1 dt/2),  k_3 = f(x + k_2 dt/2),  k_4 = f(x + k_3 dt)
x'  = x + (k_1 + 2 k_2 + 2 k_3 + k_4) dt / 6
"""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import EnvState

HILLS = ((-0.6, 0.15, 0.6), (0.05, 0.12, 0.8), (0.65, 0.1, 1.0))  # place, width [m], height


def rk4(f: Callable[[Any], Any], x: Any, dt: float) -> Any:
    """`x` after dt [s] of x' = f(x); x is any pytree of arrays."""

    def ahead(k: Any, by: float) -> Any:
        return jax.tree.map(lambda x, k: x + by * k, x, k)

    a = f(x)
    b = f(ahead(a, dt / 2))
    c = f(ahead(b, dt / 2))
    d = f(ahead(c, dt))
    slope = jax.tree.map(lambda a, b, c, d: (a + 2 * b + 2 * c + d) / 6, a, b, c, d)
    return ahead(slope, dt)


def hills(x: Array) -> Array:
    """phi [...] at x [...] in [-1, 1] m: three peaks, the highest of height 1 at 0.65."""
    each = [h * jnp.exp(-0.5 * ((x - at) / width) ** 2) for at, width, h in HILLS]
    return sum(each[1:], each[0])


def state(x: Array, reward: Array, terminated: Array | bool = False) -> EnvState:
    """The state of a world whose observation is its whole state x [o]."""
    ended = jnp.asarray(terminated)
    return EnvState(x, x, reward, ended, jnp.zeros((), bool), {}, {})
