"""The regulator of a linear system, by Riccati's equation.

    e' = A e + B u,   P = Q + A' P A - A' P B K,   K = (R + B' P B)^-1 B' P A,   u = -K e

V(e) = e' P e decreases along e' = (A - B K) e: V(e') - V(e) = -e' (Q + K' R K) e.
Source: discrete algebraic Riccati equation, solved by SciPy.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_discrete_are


class Regulator(NamedTuple):
    """The optimal gain and cost of a linear system."""

    gain: np.ndarray  # K [m, d]
    value: np.ndarray  # P [d, d]


def regulator(A: np.ndarray, B: np.ndarray, Q: np.ndarray, R: np.ndarray) -> Regulator:
    """The regulator of e' = A e + B u under the cost sum e' Q e + u' R u, Q [d, d], R [m, m].

    Raises:
        numpy.linalg.LinAlgError: if the system cannot be stabilised.
    """
    P = solve_discrete_are(A, B, Q, R)
    return Regulator(np.linalg.solve(R + B.T @ P @ B, B.T @ P @ A), P)


def as_weights(name: str, weights: tuple[float, ...], size: int) -> np.ndarray:
    """The diagonal matrix [size, size] of `weights`: one for all entries, or one for each."""
    if len(weights) not in (1, size):
        raise ValueError(f"{name}={list(weights)}: must hold 1 weight or {size}")
    return np.diag(np.broadcast_to(np.asarray(weights, float), (size,)))
