"""Solutions of small linear systems, many of them side by side under `vmap`.

LAPACK's batched routines in jaxlib split a batch over the threads of XLA's pool and wait for them.
If as many of them run at once as the pool has threads, none is left to do the work, and the program
hangs (jaxlib 0.10, two cores). On a CPU the systems of a batch are therefore solved one after the
other.
"""

from typing import Any

import jax
import jax.numpy as jnp
from jax import Array
from jax.custom_batching import custom_vmap

from hybrid_rl.core.batching import batch_all


@custom_vmap
def solve(A: Array, B: Array) -> Array:
    """X [n, k] of A X = B, A [n, n]; it has no reverse-mode derivative."""
    return jnp.linalg.solve(A, B)


@solve.def_vmap
def _(size: int, batched: Any, A: Array, B: Array) -> tuple[Array, bool]:
    A, B = batch_all(size, batched, [A, B])
    if jax.default_backend() == "cpu":
        return jax.lax.map(lambda pair: solve(*pair), (A, B)), True
    return jax.vmap(jnp.linalg.solve)(A, B), True


def solve_upper(U: Array, B: Array) -> Array:
    """X [n, k] of U X = B, U [n, n] upper triangular, by back substitution."""
    n = len(U)

    def substitute(step: Array, X: Array) -> Array:
        i = n - 1 - step
        row = jax.lax.dynamic_index_in_dim(U, i, 0, keepdims=False)
        right = jax.lax.dynamic_index_in_dim(B, i, 0, keepdims=False)
        pivot = jax.lax.dynamic_index_in_dim(row, i, 0, keepdims=False)
        known = jnp.where(jnp.arange(n) > i, row, 0) @ X
        return jax.lax.dynamic_update_index_in_dim(X, (right - known) / pivot, i, 0)

    return jax.lax.fori_loop(0, n, substitute, jnp.zeros_like(B))


@jax.custom_jvp
def log_det_one_plus(G: Array) -> Array:
    """log det(1 + G) [] of a symmetric positive semidefinite G [n, n]."""
    return _swept(G)[0]


@log_det_one_plus.defjvp
def _(primals: tuple[Array], tangents: tuple[Array]) -> tuple[Array, Array]:
    (G,), (change,) = primals, tangents
    value, inverse = _swept(G)
    return value, jnp.sum(inverse * change)


def _swept(G: Array) -> tuple[Array, Array]:
    """log det(1 + G) [] and (1 + G)^-1 [n, n], by sweeping the rows one after the other.

    What rounding does to the largest entry is added to 1, and no pivot is below that: G may be
    singular and of any size. Source: Goodnight, A tutorial on the SWEEP operator, The American
    Statistician 33, 1979.
    """
    n = len(G)
    least = 1 + 4 * jnp.finfo(G.dtype).eps * jnp.max(jnp.diagonal(G))

    def sweep(k: Array, held: tuple[Array, Array]) -> tuple[Array, Array]:
        A, total = held
        row = jax.lax.dynamic_index_in_dim(A, k, 0, keepdims=False)
        column = jax.lax.dynamic_index_in_dim(A, k, 1, keepdims=False)
        pivot = jnp.maximum(jax.lax.dynamic_index_in_dim(row, k, 0, keepdims=False), least)
        A = A - column[:, None] * (row / pivot)[None]
        A = jax.lax.dynamic_update_index_in_dim(A, row / pivot, k, 0)
        A = jax.lax.dynamic_update_index_in_dim(A, -column / pivot, k, 1)
        return A.at[k, k].set(1 / pivot), total + jnp.log(pivot)

    start = least * jnp.eye(n, dtype=G.dtype) + G, jnp.zeros((), G.dtype)
    A, total = jax.lax.fori_loop(0, n, sweep, start)
    return total, A
