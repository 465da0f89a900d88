"""u = clip(u_0 - K e): the linear-quadratic regulator around an equilibrium.

V(x) = e' P e is its Lyapunov function (thesis eq. 6.4): it decreases as long as the action is not
clipped and the dynamics are nearly linear. With `free` coordinates f, V is the minimum over these,

    V(x) = min_f e' P e = e' (P - P_f P_ff^-1 P_f') e,

the distance to the nearest state that differs from the equilibrium only in f, such as the position
of a cart.
"""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core import riccati
from hybrid_rl.fields import FieldError, Positive, part
from hybrid_rl.protocols import Analytic
from hybrid_rl.types import Room, Spec


@part
class Regulator:
    """The regulator of `world` around its equilibrium, by the discrete Riccati equation."""

    world: Analytic
    state_weights: tuple[Positive, ...] = (1.0,)  # diagonal of Q: one for all, or [d]
    action_weights: tuple[Positive, ...] = (1.0,)  # diagonal of R, of actions in [-1, 1]
    free: tuple[int, ...] = ()  # f, indices of e [d] that V ignores
    clip: bool = True  # actions to [-1, 1]; false where noise is added to them

    def __post_init__(self) -> None:
        self._weights()
        size = riccati.sizes(self.world)[0]
        if not {*self.free} < {*range(size)}:
            raise FieldError(self, "free", f"must be some of 0 to {size - 1}, not all")

    def solve(self) -> tuple[np.ndarray, np.ndarray]:
        """K [m, d] and P [d, d]."""
        a, b = riccati.at_equilibrium(self.world)
        try:
            return riccati.regulator(a, b, *self._weights())
        except np.linalg.LinAlgError:
            line = "no action stabilises what is unstable at its equilibrium()"
            raise ValueError(f"env: {type(self.world).__name__}: {line}") from None

    def _weights(self) -> tuple[np.ndarray, np.ndarray]:
        """Q [d, d] and R [m, m]."""
        d, m = riccati.sizes(self.world)
        q = riccati.as_weights("equilibrium.state_weights", self.state_weights, d)
        return q, riccati.as_weights("equilibrium.action_weights", self.action_weights, m)

    def init(self, key: Array, spec: Spec) -> tuple[()]:
        """No parameters."""
        return ()

    def _local(self, x: Array) -> Array:
        """Local coordinates e [d] of the observation in x [n]."""
        return self.world.to_local(x[: self.world.equilibrium()[0].size])

    def towards(self, x: Array, goal: Array) -> Array:
        """The action [m] at x [n] that leads to `goal` [o] instead of the equilibrium."""
        e, hold = self._local(x) - self.world.to_local(goal), self.world.equilibrium()[1]
        u = hold - jnp.asarray(self.solve()[0], e.dtype) @ e
        return jnp.clip(u, -1, 1) if self.clip else u

    def mean(self, params: Any, x: Array) -> Array:
        """The action [m] at x [n]."""
        return self.towards(x, self.world.equilibrium()[0])

    def sample(self, params: Any, x: Array, noise: Array) -> tuple[Array, Array]:
        """The same action for any noise; the log-density of a deterministic action is 0."""
        return self.mean(params, x), jnp.zeros(())

    def variance(self, params: Any, x: Array) -> Array:
        """Zero [m]: the policy is deterministic."""
        return jnp.zeros_like(self.mean(params, x))

    def room(self) -> Room | None:
        """What it leaves to others before its action is clipped; None: the world is stable."""
        with jax.ensure_compile_time_eval():
            spare = 1 - np.abs(np.asarray(self.world.equilibrium()[1], float))
        a, b = riccati.at_equilibrium(self.world)
        return riccati.room(a, b, self.solve()[0], spare)

    def lyapunov(self, x: Array) -> Array:
        """V(x) [] at x [n]."""
        e, P, f = self._local(x), self.solve()[1], list(self.free)
        P = P - P[:, f] @ np.linalg.solve(P[np.ix_(f, f)], P[f])
        return e @ jnp.asarray(P, e.dtype) @ e
