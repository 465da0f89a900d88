"""Iterative LQR: a locally optimal path of a known system from one start.

    J = sum_t x_{t+1}' Q x_{t+1} + u_t' R u_t,   x_{t+1} = f(x_t, u_t)
    du = k + K dx from the Riccati recursion along the path, u <- u + a k + K dx, a by line search

Source: Li and Todorov, Iterative linear quadratic regulator design, ICINCO 2004. It bounds what a
regulator can reach, up to local minima; actions are not limited.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.adjoint import roll
from hybrid_rl.core.riccati import linearise
from hybrid_rl.types import Path, Step

SHARES = (1.0, 0.5, 0.25, 0.1, 0.03)  # of a step, tried in each iteration
ITERATIONS = 30


def cost(path: Path, Q: Array, R: Array) -> Array:
    """J [] of a path; Q [n, n], R [m, m]."""
    x, u = path.x[1:], path.u
    return jnp.sum((x @ Q) * x) + jnp.sum((u @ R) * u)


def optimal(step: Step, Q: Array, R: Array, x: Array, u: Array, rounds: int = ITERATIONS) -> Path:
    """The path from x [n] after `rounds` iterations, the first actions being u [T, m]."""

    def iterate(path: Path, _: None) -> tuple[Path, None]:
        k, K = _backward(step, Q, R, path)
        tried = [_forward(step, path, share * k, K) for share in SHARES]
        every = jax.tree.map(lambda *leaves: jnp.stack(leaves), path, *tried)
        costs = jax.vmap(cost, (0, None, None))(every, Q, R)
        best = jnp.argmin(jnp.where(jnp.isfinite(costs), costs, jnp.inf))
        return jax.tree.map(lambda leaf: leaf[best], every), None

    first = roll(step, lambda x: jnp.zeros_like(u[0]), x, u)
    return jax.lax.scan(iterate, first, None, length=rounds)[0]


def _backward(step: Step, Q: Array, R: Array, path: Path) -> tuple[Array, Array]:
    """k [T, m] and K [T, m, n] along a path."""
    A, B = jax.vmap(lambda x, u: linearise(step, x, u))(path.x[:-1], path.u)

    def back(after: tuple[Array, Array], at: tuple[Array, ...]) -> tuple[tuple, tuple]:
        (P, p), (A, B, x, u) = after, at
        both = jnp.concatenate([(R @ u + B.T @ p)[:, None], B.T @ P @ A], axis=1)
        solved = -jnp.linalg.solve(R + B.T @ P @ B, both)
        k, K = solved[:, 0], solved[:, 1:]
        P_before = Q + A.T @ P @ (A + B @ K)
        return (0.5 * (P_before + P_before.T), Q @ x + A.T @ (p + P @ B @ k)), (k, K)

    end = Q, Q @ path.x[-1]
    return jax.lax.scan(back, end, (A, B, path.x[:-1], path.u), reverse=True)[1]


def _forward(step: Step, path: Path, k: Array, K: Array) -> Path:
    """The path with the corrections k [T, m] and gains K [T, m, n] around `path`."""

    def forward(x: Array, at: tuple[Array, ...]) -> tuple[Array, tuple[Array, Array]]:
        around, u, k, K = at
        u = u + k + K @ (x - around)
        after = step(x, u)
        return after, (after, u)

    _, (x, u) = jax.lax.scan(forward, path.x[0], (path.x[:-1], path.u, k, K))
    return Path(jnp.concatenate([path.x[:1], x]), u)
