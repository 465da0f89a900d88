"""Change of a Lyapunov function V by exploration around an equilibrium, and a guard.

    rate  = V(f(x, pi(x))) - V(x)                                     under the policy
    bound = max_t V(f(x_t, u_t)) - V(f(x_t, pi(x_t)))                 thesis eq. (6.15), beta
    u     = u if V(f(x, u)) <= level else pi(x)                       the set C of Definition 4

All per decision. Where f is affine in u, V(f(x, u)) - V(f(x, pi)) is V_x h (u - pi) dt to first
order, as printed. Theorem 3, V(x^lambda) - V(x) <= lambda beta, is first-order in lambda.
"""

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import Path, Step

Policy = Callable[[Array], Array]
Scalar = Callable[[Array], Array]


class Record(NamedTuple):
    """V along one plan."""

    now: Array  # [] V at the first state
    rate: Array  # [] [V per decision]
    bound: Array  # [] [V per decision]


def record(V: Scalar, step: Step, policy: Policy, path: Path) -> Record:
    """The record of `path` x [T+1, n], u [T, m] under the model `step`; `policy` is pi(x)."""

    def apart(x: Array, u: Array) -> Array:
        return V(step(x, u)) - V(step(x, policy(x)))

    x, now = path.x[0], V(path.x[0])
    bound = jnp.max(jax.vmap(apart)(path.x[:-1], path.u))
    return Record(now, V(step(x, policy(x))) - now, bound)


def exits_level_set(V: Scalar, step: Step, x: Array, u: Array, level: float) -> Array:
    """Whether [] action u [m] at x [n] leads out of the level set V <= level."""
    return V(step(x, u)) > level
