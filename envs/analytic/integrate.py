"""The classical Runge-Kutta method.

k_1 = f(x),  k_2 = f(x + k_1 dt/2),  k_3 = f(x + k_2 dt/2),  k_4 = f(x + k_3 dt)
x'  = x + (k_1 + 2 k_2 + 2 k_3 + k_4) dt / 6
"""

from collections.abc import Callable
from typing import Any

import jax


def rk4(f: Callable[[Any], Any], x: Any, dt: float, steps: int = 1) -> Any:
    """The solution of dx/dt = f(x) after `steps` of dt [s]; x is any pytree of arrays."""

    def add(x: Any, k: Any, scale: float) -> Any:
        return jax.tree.map(lambda x, k: x + scale * k, x, k)

    for _ in range(steps):
        a = f(x)
        b = f(add(x, a, dt / 2))
        c = f(add(x, b, dt / 2))
        d = f(add(x, c, dt))
        slope = jax.tree.map(lambda a, b, c, d: (a + 2 * b + 2 * c + d) / 6, a, b, c, d)
        x = add(x, slope, dt)
    return x
