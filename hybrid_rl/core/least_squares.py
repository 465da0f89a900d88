"""Recursive least squares in square-root form, with forgetting and a prior that is not forgotten.

    K = argmin sum_i f^(N-i) |y_i - K s_i|^2 + lam |K - K_0|^2

    U'U = lam I + sum_i f^(N-i) s_i s_i',   U'Y = lam K_0' + sum_i f^(N-i) s_i y_i',   K' = U^-1 Y

U is upper triangular. New rows are folded into it by Householder reflections, so that U'U, whose
condition number is the square of U's, is never formed: in float32 the error is orders of magnitude
smaller than with sums. Without the prior's rows, which every step with f < 1 adds again, directions
that the data do not excite would lose their prior.

s [r] regressor, y [a] output. Source: the QR decomposition of a triangle on top of a rectangle
(Golub and Van Loan, Matrix Computations, section 5.2); the thesis' eq. (2.11) has sums and a
pseudo-inverse.
"""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.solving import solve_upper
from hybrid_rl.protocols import LinearModel


class Factor(NamedTuple):
    """The square root of the information, and the right-hand side of the regression."""

    U: Array  # [r, r] upper triangular
    Y: Array  # [r, a]


def begin(mean: Array, prior: float | Array) -> Factor:
    """The regression before any data: K is `mean` [a, r], with weight `prior` above 0."""
    scale = jnp.sqrt(prior)
    return Factor(scale * jnp.eye(mean.shape[1]), scale * mean.T)


def add(
    factor: Factor,
    inputs: Array,
    outputs: Array,
    mean: Array,
    prior: float | Array = 0.0,
    forgetting: float | Array = 1.0,
) -> Factor:
    """The regression after one step of forgetting and rows `inputs` [B, r], `outputs` [B, a].

    `mean` [a, r] and `prior` are those of `begin`; with forgetting = 1 they have no effect.
    """
    if not isinstance(forgetting, Array) and forgetting == 1:
        return fold(factor, inputs, outputs)
    root = jnp.sqrt(forgetting)
    again = begin(mean, (1 - forgetting) * prior)
    rows = jnp.concatenate([again.U, inputs]), jnp.concatenate([again.Y, outputs])
    return fold(Factor(root * factor.U, root * factor.Y), *rows)


def fold(factor: Factor, inputs: Array, outputs: Array) -> Factor:
    """The factor of the rows [B, r], [B, a] too: U'U + inputs' inputs, U'Y + inputs' outputs."""
    size = len(factor.U)
    top = jnp.concatenate([factor.U, factor.Y], axis=1)
    rows = jnp.concatenate([inputs, outputs], axis=1)

    def reflect(j: Array, both: tuple[Array, Array]) -> tuple[Array, Array]:
        top, rows = both
        line = jax.lax.dynamic_index_in_dim(top, j, 0, keepdims=False)
        pivot = jax.lax.dynamic_index_in_dim(line, j, 0, keepdims=False)
        column = jax.lax.dynamic_index_in_dim(rows, j, 1, keepdims=False)
        below = jnp.sum(column**2)
        length = jnp.where(pivot < 0, -1, 1) * jnp.sqrt(pivot**2 + below)
        first = pivot + length  # without cancellation: both have one sign
        scale = jnp.where(below > 0, 1 / jnp.where(below > 0, length * first, 1), 0)
        # H = I - w w' scale, w = (first, column)
        share = scale * (first * line + column @ rows)
        top = jax.lax.dynamic_update_index_in_dim(top, line - first * share, j, 0)
        return top, rows - column[:, None] * share[None]

    top, _ = jax.lax.fori_loop(0, size, reflect, (top, rows))
    return Factor(jnp.triu(top[:, :size]), top[:, size:])


def rows(model: LinearModel, params: Any, made: Any) -> tuple[Array, Array]:
    """Regressors s [B, r] and changes x' - x [B, n] of B decisions, a Transition or Batch."""

    def one(obs: Array, u: Array, next_obs: Array) -> tuple[Array, Array]:
        x = model.lift(params, obs)
        return model.regressors(params, x, u), model.lift(params, next_obs) - x

    return jax.vmap(one)(*map(jnp.asarray, (made.obs, made.action, made.next_obs)))


def solve(factor: Factor) -> tuple[Array, Array]:
    """K [a, r], and W = U^-1 [r, r], with W W' the covariance of its rows in the noise's units."""
    both = solve_upper(factor.U, jnp.concatenate([factor.Y, jnp.eye(len(factor.U))], axis=1))
    outputs = factor.Y.shape[1]
    return both[:, :outputs].T, both[:, outputs:]


def leverage(W: Array, s: Array) -> Array:
    """s' W W' s [] of a regressor s [r]: the variance of K s in units of the noise's."""
    return jnp.sum((s @ W) ** 2)


def log_det(U: Array) -> Array:
    """log det U'U []."""
    return 2 * jnp.sum(jnp.log(jnp.abs(jnp.diagonal(U))))
