"""The regulator of a linear system, by Riccati's equation; linearisation of known dynamics.

    e' = A e + B u,   P = Q + A' P A - A' P B K,   K = (R + B' P B)^-1 B' P A,   u = -K e

V(e) = e' P e decreases along e' = (A - B K) e: V(e') - V(e) = -e' (Q + K' R K) e.
Source: discrete algebraic Riccati equation, solved by SciPy for constants. In compiled programs T
steps from P = 0 take log2(T) doublings (structure-preserving doubling, Chu et al. 2004):

    A <- A (I + G H)^-1 A,   G <- G + A (I + G H)^-1 G A',   H <- H + A' H (I + G H)^-1 A

from G = B R^-1 B', H = Q. H of k doublings is the cost to go over 2^k steps.
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from scipy.linalg import solve_discrete_are

from hybrid_rl.core.solving import solve
from hybrid_rl.protocols import AnalyticEnv
from hybrid_rl.types import Room

STILL = 1e-4  # motion in a decision at an equilibrium, of the size of its state
LEAST = 1e-300  # modulus of an eigenvalue, so that it has a logarithm
SLOW = 0.1  # growth in a time constant of the regulator below which a system is not unstable


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


def room(A: np.ndarray, B: np.ndarray, K: np.ndarray, spare: np.ndarray) -> Room | None:
    """The room of u = u_0 - K e + v, if v - K e may use `spare` [m]; None: e' = A e is stable.

    Corrections |v_j| <= most, whatever their course, keep |v - K e| <= spare from e = 0 on, since
    |K e|_i <= most sum_j sum_k |K (A - B K)^k B|_ij. A stable system needs no such bound.
    """
    loop = A - B @ K
    own, closed = (max(np.abs(np.linalg.eigvals(M)).max(), LEAST) for M in (A, loop))
    time = -1 / np.log(closed)
    if time * np.log(own) < SLOW:
        return None
    e, used = B, np.ones(len(K))
    for _ in range(int(np.ceil(20 * time))):
        used = used + np.abs(K @ e).sum(1)
        e = loop @ e
    return Room(float((spare / used).min()), float(time))


def finite_horizon(A: Array, B: Array, Q: Array, R: Array, steps: int) -> Array:
    """P [n, n] of the cost over `steps` decisions: A [n, n], B [n, m], Q [n, n], R [m, m].

    It is finite also where no gain stabilises the system, unless float32 overflows.
    """
    eye = jnp.eye(len(A), dtype=A.dtype)
    G, H, P = _symmetric(B @ solve(R, B.T)), Q, None
    while True:
        if steps % 2:  # put 2^k steps, of which A, G and H are the map, before those of P
            back = H if P is None else H + A.T @ P @ solve(eye + G @ P, A)
            P = _symmetric(back)
        steps //= 2
        if not steps:
            return P
        both = solve(eye + G @ H, jnp.concatenate([A, G], axis=1))
        forward, spread = jnp.split(both, 2, axis=1)
        A, G, H = A @ forward, _symmetric(G + A @ spread @ A.T), _symmetric(H + A.T @ H @ forward)


def gain(A: Array, B: Array, P: Array, R: Array) -> Array:
    """K [m, n] = (R + B' P B)^-1 B' P A, with shapes as of `finite_horizon`."""
    return solve(_symmetric(R + B.T @ P @ B), B.T @ P @ A)


def _symmetric(P: Array) -> Array:
    return 0.5 * (P + P.T)


def as_weights(name: str, weights: tuple[float, ...], size: int) -> np.ndarray:
    """The diagonal matrix [size, size] of `weights`: one for all entries, or one for each."""
    if len(weights) not in (1, size):
        raise ValueError(f"{name}={list(weights)}: must hold 1 weight or {size}")
    return np.diag(np.broadcast_to(np.asarray(weights, float), (size,)))


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
