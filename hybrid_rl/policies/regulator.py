"""u = clip(u_0 - K e): back to a world's equilibrium, by the linear-quadratic regulator.

V(x) = e' P e is its Lyapunov function (thesis eq. 6.4): it falls as long as the action is not
clipped and the world is linear enough. With `free` coordinates V is the least over these,

    V(x) = min_f e' P e = e' (P - P_f P_ff^-1 P_f') e,

how far x is from the nearest state that differs in them alone: a cart that may stand anywhere.
"""

from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core import riccati
from hybrid_rl.types import AnalyticEnv, Spec


@dataclass(frozen=True)
class Regulator:
    """The regulator of `world` around its equilibrium, by the discrete Riccati equation.

    Raises:
        ValueError: for a world that is no formula, or weights that fit none of its sizes.
    """

    world: AnalyticEnv
    state_weights: tuple[float, ...] = (1.0,)  # diagonal of Q: one for all, or [d]
    action_weights: tuple[float, ...] = (1.0,)  # diagonal of R, of actions in [-1, 1]
    free: tuple[int, ...] = ()  # f, of the coordinates [d], which V does not count

    def __post_init__(self) -> None:
        """Check the world and the weights."""
        riccati.check("equilibrium", self.world)
        for name in ("state_weights", "action_weights"):
            given = tuple(getattr(self, name))
            object.__setattr__(self, name, given)
            if not all(weight > 0 for weight in given):
                raise ValueError(f"equilibrium.{name}={list(given)}: must be above 0")
        object.__setattr__(self, "free", tuple(self.free))

    def solve(self) -> tuple[np.ndarray, np.ndarray]:
        """K [m, d] and P [d, d]."""
        a, b = riccati.around_rest(self.world)
        q = riccati.as_weights("equilibrium.state_weights", self.state_weights, len(a))
        r = riccati.as_weights("equilibrium.action_weights", self.action_weights, b.shape[1])
        return riccati.regulator(a, b, q, r)

    def init(self, key: Array, spec: Spec) -> tuple[()]:
        """Nothing is learned."""
        return ()

    def towards(self, x: Array, goal: Array) -> Array:
        """The action [m] at x [o] that leads to `goal` [o] instead of the equilibrium."""
        e = self.world.to_local(x) - self.world.to_local(goal)
        return jnp.clip(
            self.world.equilibrium()[1] - jnp.asarray(self.solve()[0], e.dtype) @ e, -1, 1
        )

    def mean(self, params: Any, x: Array) -> Array:
        """The action [m] at x [o]."""
        return self.towards(x, self.world.equilibrium()[0])

    def sample(self, params: Any, x: Array, noise: Array) -> tuple[Array, Array]:
        """The same action, whatever the noise; log-density of a deterministic action: 0."""
        return self.mean(params, x), jnp.zeros(())

    def variance(self, params: Any, x: Array) -> Array:
        """Zero [m]: it has no noise."""
        return jnp.zeros_like(self.mean(params, x))

    def lyapunov(self, x: Array) -> Array:
        """V [] at x [o]."""
        e, P, f = self.world.to_local(x), self.solve()[1], list(self.free)
        P = P - P[:, f] @ np.linalg.solve(P[np.ix_(f, f)], P[f])
        return e @ jnp.asarray(P, e.dtype) @ e
