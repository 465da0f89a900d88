"""Linearisation, and environments whose dynamics are known."""

from collections.abc import Callable
from functools import cache

import jax
import numpy as np
from jax import Array

from hybrid_rl.protocols import AnalyticEnv

STILL = 1e-4  # motion in a decision at an equilibrium, of the size of its state


def linearise(step: Callable[[Array, Array], Array], e: Array, u: Array) -> tuple[Array, Array]:
    """A [d, d] and B [d, m] of `step` at e [d], u [m]."""
    return jax.jacfwd(step, argnums=(0, 1))(e, u)


@cache
def at_equilibrium(world: AnalyticEnv) -> tuple[np.ndarray, np.ndarray]:
    """A [d, d] and B [d, m] of `world` at its equilibrium, in local coordinates, in float64."""
    with jax.enable_x64(True), jax.ensure_compile_time_eval():
        x, u = world.equilibrium()

        def step(e: Array, u: Array) -> Array:
            return world.to_local(world.dynamics(world.from_local(e), u))

        e = world.to_local(x)
        a, b = map(np.asarray, linearise(step, e, u))
        moved = float(np.abs(step(e, u) - e).max())
    rests = moved < STILL * max(1, float(np.abs(x).max()))
    if not (rests and np.isfinite(a).all() and np.isfinite(b).all()):
        line = "must be a state and an action at rest, where dynamics have derivatives"
        raise ValueError(f"env: {type(world).__name__}.equilibrium(): {line}; moves by {moved:.2g}")
    return a, b


def sizes(world: AnalyticEnv) -> tuple[int, int]:
    """d and m: the numbers of local coordinates and of actions."""
    return jax.eval_shape(lambda: world.to_local(world.equilibrium()[0])).size, world.spec.act
