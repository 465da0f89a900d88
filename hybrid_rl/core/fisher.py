"""Fisher information about the parameters theta [P] of a function with Gaussian noise.

    y ~ N(f(theta, z), diag(sigma^2)),   F = df / dtheta [n, P],   I = sum F' Sigma^-1 F

Along a path of x_{t+1} = f(x_t, u_t, theta), F is one of two derivatives:

    step  F_t = f_theta at (x_t, u_t): the states are measured (one-step likelihood)
    path  psi_{t+1} = f_x psi_t + f_theta, psi_0 = 0: only x_0 is known, and F_t = psi_{t+1}

`diagonal` keeps the diagonal of I. `log_det` is exact, with a matrix of size T n instead of P
(Sylvester's identity). Source: thesis eq. (4.2)-(4.3), which has the second kind only, though its
model maximises the one-step likelihood.
"""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array
from jax.flatten_util import ravel_pytree

from hybrid_rl.types import Path

ParametricStep = Callable[[Any, Array, Array], Array]  # theta, x [n], u [m] -> x' [n]


def jacobian(f: Callable[[Any], Array], theta: Any) -> Array:
    """df / dtheta [n, P] of f(theta) [n], with the leaves of theta concatenated."""
    flat, unravel = ravel_pytree(theta)
    y, pull = jax.vjp(lambda flat: f(unravel(flat)), flat)
    return jax.vmap(pull)(jnp.eye(y.size, dtype=y.dtype))[0]


def jacobians(step: ParametricStep, theta: Any, x: Array, u: Array) -> tuple[Array, Array]:
    """f_x [n, n] and f_theta [n, P] at x [n], u [m]."""
    flat, unravel = ravel_pytree(theta)
    y, pull = jax.vjp(lambda flat, x: step(unravel(flat), x, u), flat, x)
    f_theta, f_x = jax.vmap(pull)(jnp.eye(y.size, dtype=y.dtype))
    return f_x, f_theta


def along(step: ParametricStep, theta: Any, path: Path, kind: str) -> Array:
    """F [T, n, P] along path, x [T+1, n] and u [T, m]; kind: step or path."""
    if kind == "step":
        one = jax.vmap(lambda x, u: jacobian(lambda theta: step(theta, x, u), theta))
        return one(path.x[:-1], path.u)

    def forward(psi: Array, at: tuple[Array, Array]) -> tuple[Array, Array]:
        f_x, f_theta = jacobians(step, theta, *at)
        psi = f_x @ psi + f_theta
        return psi, psi

    n, P = path.x.shape[1], ravel_pytree(theta)[0].size
    return jax.lax.scan(forward, jnp.zeros((n, P), path.x.dtype), (path.x[:-1], path.u))[1]


def diagonal(F: Array, sigma: Array) -> Array:
    """The diagonals of F' Sigma^-1 F [..., P] for F [..., n, P] and sigma [n]."""
    return jnp.sum((F / sigma[:, None]) ** 2, -2)


def log_det(F: Array, sigma: Array, prior: Array) -> Array:
    """log det(I + diag(prior)) - log det(diag(prior)) [] for F [T, n, P] and prior [P] above 0.

    It equals log det(1 + G), G = Sigma^-1/2 F diag(prior)^-1 F' Sigma^-1/2 [T n, T n].
    """
    rows = (F / sigma[:, None]).reshape(-1, F.shape[-1]) / jnp.sqrt(prior)
    factor = jnp.linalg.cholesky(jnp.eye(len(rows), dtype=rows.dtype) + rows @ rows.T)
    return 2 * jnp.sum(jnp.log(jnp.diag(factor)))
