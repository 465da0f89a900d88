"""Linearisation, and environments whose dynamics are known."""

from collections.abc import Callable
from functools import cache

import jax
import numpy as np
from jax import Array

from hybrid_rl.protocols import AnalyticEnv, BalancedEnv, RewardedEnv


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

        a, b = linearise(step, world.to_local(x), u)
        return np.asarray(a), np.asarray(b)


def sizes(world: AnalyticEnv) -> tuple[int, int]:
    """d and m: the numbers of local coordinates and of actions."""
    return jax.eval_shape(lambda: world.to_local(world.equilibrium()[0])).size, world.spec.act


def require(name: str, world: AnalyticEnv) -> None:
    """Raise ValueError unless `world`, a field of the part `name`, is analytic."""
    if not hasattr(world, "dynamics"):
        raise ValueError(f"{name}.world={type(world).__name__}: needs an analytic environment")


def require_equilibrium(name: str, world: BalancedEnv) -> None:
    """Raise ValueError unless `world`, a field of the part `name`, has an equilibrium."""
    if not hasattr(world, "equilibrium"):
        kind = type(world).__name__
        raise ValueError(f"{name}.world={kind}: needs an environment with an equilibrium")


def require_reward(name: str, world: RewardedEnv) -> None:
    """Raise ValueError unless the reward of `world`, a field of the part `name`, is known."""
    if not hasattr(world, "reward_of"):
        kind = type(world).__name__
        raise ValueError(f"{name}.world={kind}: needs an environment with a known reward")
