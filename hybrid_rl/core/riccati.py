"""Linearisation, and the regulator of a linear system by Riccati's equation.

    e' = A e + B u,   P = Q + A' P A - A' P B K,   K = (R + B' P B)^-1 B' P A,   u = -K e

V(e) = e' P e falls along e' = (A - B K) e: V(e') - V(e) = -e' (Q + K' R K) e.
Source: discrete algebraic Riccati equation, solved by SciPy.
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import jax
import numpy as np
from jax import Array
from scipy.linalg import solve_discrete_are

from hybrid_rl.types import AnalyticEnv


class Regulator(NamedTuple):
    """Of a linear system."""

    gain: np.ndarray  # K [m, d]
    value: np.ndarray  # P [d, d]


def linearise(step: Callable[[Array, Array], Array], e: Array, u: Array) -> tuple[Array, Array]:
    """A [d, d] and B [d, m] of `step` at e [d], u [m]."""
    return jax.jacfwd(step, argnums=(0, 1))(e, u)


@cache
def around_rest(world: AnalyticEnv) -> tuple[np.ndarray, np.ndarray]:
    """A [d, d] and B [d, m] of `world` at its equilibrium, in its own coordinates, in float64."""
    with jax.enable_x64(True), jax.ensure_compile_time_eval():
        x, u = world.equilibrium()
        e = world.to_local(x)
        a, b = linearise(lambda e, u: world.to_local(world.dynamics(world.from_local(e), u)), e, u)
        return np.asarray(a), np.asarray(b)


def regulator(A: np.ndarray, B: np.ndarray, Q: np.ndarray, R: np.ndarray) -> Regulator:
    """Of e' = A e + B u under the cost sum e' Q e + u' R u, Q [d, d], R [m, m].

    Raises:
        numpy.linalg.LinAlgError: where nothing stabilises the system.
    """
    P = solve_discrete_are(A, B, Q, R)
    return Regulator(np.linalg.solve(R + B.T @ P @ B, B.T @ P @ A), P)


def check(name: str, world: AnalyticEnv) -> None:
    """Raise ValueError where `world` is no formula with an equilibrium."""
    try:
        world.equilibrium()
    except AttributeError as error:
        kind = type(world).__name__
        raise ValueError(f"{name}.world={kind}: needs an analytic world") from error


def as_weights(name: str, given: tuple[float, ...], size: int) -> np.ndarray:
    """The diagonal matrix [size, size] of `given`: one weight for all, or one each."""
    if len(given) not in (1, size):
        raise ValueError(f"{name}={list(given)}: must hold 1 weight or {size}")
    return np.diag(np.broadcast_to(np.asarray(given, float), (size,)))
