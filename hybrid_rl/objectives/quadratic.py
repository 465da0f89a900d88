"""J = -sum_t e_{t+1}' Q e_{t+1} + (u_t - u_0)' R (u_t - u_0): be at a world's equilibrium, soon.

e are the world's coordinates there. The return is known; nothing of it is learned.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import riccati
from hybrid_rl.types import AnalyticEnv, Params, Path, Spec


@dataclass(frozen=True)
class Quadratic:
    """Minus the squared distance to the equilibrium, summed along a path.

    Raises:
        ValueError: for a world that is no formula, or weights below 0.
    """

    world: AnalyticEnv
    state_weights: tuple[float, ...] = (1.0,)  # diagonal of Q: one for all, or [d]
    action_weights: tuple[float, ...] = (0.0,)  # diagonal of R: one for all, or [m]
    discount: float = 1.0  # per decision

    def __post_init__(self) -> None:
        """Check the world and the weights."""
        riccati.check("regulation", self.world)
        for name in ("state_weights", "action_weights"):
            given = tuple(getattr(self, name))
            object.__setattr__(self, name, given)
            if not all(weight >= 0 for weight in given):
                raise ValueError(f"regulation.{name}={list(given)}: must be 0 or more")

    def begin(self, spec: Spec) -> tuple[()]:
        """Nothing is remembered."""
        return ()

    def look(self, params: Params, memory: tuple[()], x: Array, key: Array) -> tuple[()]:
        """Nothing is drawn."""
        return memory

    def value(self, params: Params, memory: tuple[()], path: Path) -> Array:
        """J [] of `path`."""
        return self.reward_to_go(params, path)[0]

    def rewards(self, params: Params, path: Path) -> Array:
        """r [T] along path, x [T+1, o] and u [T, m]."""
        e, v = jax.vmap(self.world.to_local)(path.x[1:]), path.u - self.world.equilibrium()[1][None]
        q, r = jnp.array(self.state_weights), jnp.array(self.action_weights)
        return -jnp.sum(q[None] * e**2, -1) - jnp.sum(r[None] * v**2, -1)

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1] along path, x [T+1, o] and u [T, m]; S[T] is 0."""

        def back(after: Array, r: Array) -> tuple[Array, Array]:
            now = r + self.discount * after
            return now, now

        to_go = jax.lax.scan(back, jnp.zeros(()), self.rewards(params, path), reverse=True)[1]
        return jnp.append(to_go, 0.0)
