"""Fisher information about the parameters theta [P] of a function with Gaussian noise.

    y ~ N(f(theta, z), diag(sigma^2)),   F = df / dtheta [n, P],   I = sum F' Sigma^-1 F

Along a path of x_{t+1} = f(x_t, u_t, theta), F is one of two derivatives:

    step  F_t = f_theta at (x_t, u_t): the states are measured (one-step likelihood)
    path  psi_{t+1} = f_x psi_t + f_theta, psi_0 = 0: only x_0 is known, and F_t = psi_{t+1}

Criteria to maximise, I_t the diagonal of F_t' Sigma^-1 F_t and c > 0 that of what is known before:

    A_step  -sum_t tr (I_t + c)^-1          A  -tr (sum_t I_t + c)^-1
    D       log det (sum_t I_t + c) - log det c
    T       log tr (sum_t I_t + c)
    full    as D, without the approximation by the diagonal: a matrix of size T n instead of P

Source: thesis eq. (4.2)-(4.4), which has A_step by path, though its model maximises the one-step
likelihood. The names of the criteria are those of optimal design (Chaloner and Verdinelli 1995).
"""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array
from jax.flatten_util import ravel_pytree

from hybrid_rl.core.solving import log_det_one_plus
from hybrid_rl.types import Path

CRITERIA = ("A_step", "A", "D", "T", "full")
KINDS = ("step", "path")
LARGEST = 1e12  # of psi, whose square must fit into float32: it grows as a product of f_x
ParametricStep = Callable[[Any, Array, Array], Array]  # theta, x [n], u [m] -> x' [n]


def jacobian(f: Callable[[Any], Array], theta: Any) -> Array:
    """df / dtheta [n, P] of f(theta) [n], with the leaves of theta concatenated."""
    flat, unravel = ravel_pytree(theta)
    return jax.jacrev(lambda flat: f(unravel(flat)))(flat)


def along(step: ParametricStep, theta: Any, path: Path, kind: str) -> Array:
    """F [T, n, P] along path, x [T+1, n] and u [T, m]; kind: step or path."""
    assert kind in KINDS, kind
    if kind == "step":
        one = jax.vmap(lambda x, u: jacobian(lambda theta: step(theta, x, u), theta))
        return one(path.x[:-1], path.u)

    flat, unravel = ravel_pytree(theta)

    def forward(psi: Array, at: tuple[Array, Array]) -> tuple[Array, Array]:
        f = jax.jacrev(lambda flat, x, u: step(unravel(flat), x, u), (0, 1))
        f_theta, f_x = f(flat, *at)
        psi = jnp.clip(f_x @ psi + f_theta, -LARGEST, LARGEST)
        return psi, psi

    none = jnp.zeros_like(path.x, shape=(path.x.shape[1], flat.size))
    return jax.lax.scan(forward, none, (path.x[:-1], path.u))[1]


def products(step: ParametricStep, theta: Any, path: Path, kind: str, v: Any) -> Array:
    """F_t v [T, n] for a direction v like theta, at the cost of two paths and without F."""

    def forward(d: Array, at: tuple[Array, Array]) -> tuple[Array, Array]:
        x, u = at
        d = jax.jvp(lambda theta, x: step(theta, x, u), (theta, x), (v, d))[1]
        d = jnp.clip(d, -LARGEST, LARGEST)
        return d if kind == "path" else jnp.zeros_like(d), d

    none = jnp.zeros_like(path.x[0])
    return jax.lax.scan(forward, none, (path.x[:-1], path.u))[1]


def diagonal(F: Array, sigma: Array) -> Array:
    """The diagonals of F' Sigma^-1 F [..., P] for F [..., n, P] and sigma [n]."""
    return jnp.sum(_in_deviations(F, sigma) ** 2, -2)


def _in_deviations(F: Array, sigma: Array) -> Array:
    """F / sigma [..., n, P]."""
    return F / jnp.broadcast_to(sigma[:, None], F.shape)


def log_det(F: Array, sigma: Array, prior: Array) -> Array:
    """log det(I + diag(prior)) - log det(diag(prior)) [] for F [T, n, P] and prior [P] > 0.

    It equals log det(1 + G), G = Sigma^-1/2 F diag(prior)^-1 F' Sigma^-1/2 [T n, T n] (Sylvester's
    identity): twice the mutual information of the data and theta ~ N(., diag(prior)^-1).
    """
    rows = _in_deviations(F, sigma).reshape(-1, F.shape[-1]) / jnp.sqrt(prior)[None]
    return log_det_one_plus(rows @ rows.T)


def criterion(name: str, F: Array, sigma: Array, prior: Array) -> Array:
    """One of CRITERIA [] for F [T, n, P], sigma [n] and prior c [P] above 0; larger is better.

    All but `full` take the diagonal of the information, without the correlations of parameters.
    """
    assert name in CRITERIA, name
    if name == "full":
        return log_det(F, sigma, prior)
    each = diagonal(F, sigma)  # [T, P]
    if name == "A_step":
        return -jnp.sum(1 / (each + prior[None]))
    total = each.sum(0)
    if name == "A":
        return -jnp.sum(1 / (total + prior))
    if name == "D":
        return jnp.sum(jnp.log1p(total / prior))
    return jnp.log(jnp.sum(total + prior))
