"""J = -sum_t e_{t+1}' Q e_{t+1} + (u_t - u_0)' R (u_t - u_0): a quadratic cost around equilibrium.

e are the environment's local coordinates. The return is known: nothing is learned.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import analytic
from hybrid_rl.protocols import AnalyticEnv
from hybrid_rl.types import Params, Path, Return, Spec


@dataclass(frozen=True)
class Quadratic:
    """Minus the squared distance to the equilibrium, summed along a path.

    Raises:
        ValueError: for an environment that is not analytic, or weights below 0.
    """

    world: AnalyticEnv
    state_weights: tuple[float, ...] = (1.0,)  # diagonal of Q: one for all, or [d]
    action_weights: tuple[float, ...] = (0.0,)  # diagonal of R: one for all, or [m]
    discount: float = 1.0  # per decision

    def __post_init__(self) -> None:
        """Check the fields."""
        analytic.require("objective", self.world)
        for name in ("state_weights", "action_weights"):
            weights = tuple(getattr(self, name))
            object.__setattr__(self, name, weights)
            if not all(weight >= 0 for weight in weights):
                raise ValueError(f"objective.{name}={list(weights)}: must be 0 or more")

    def init(self, spec: Spec) -> tuple[()]:
        """No memory."""
        return ()

    def prepare(
        self, params: Params, memory: tuple[()], x: Array, u_before: Array, key: Array
    ) -> tuple[Return, tuple[()]]:
        """J of a path; the key is not used."""
        return lambda path: self.reward_to_go(params, path)[0], memory

    def rewards(self, params: Params, path: Path) -> Array:
        """r [T] along path, x [T+1, n] and u [T, m]."""
        rest, hold = self.world.equilibrium()
        e = jax.vmap(self.world.to_local)(path.x[1:, : rest.size])
        q, r = jnp.array(self.state_weights), jnp.array(self.action_weights)
        return -jnp.sum(q[None] * e**2, -1) - jnp.sum(r[None] * (path.u - hold[None]) ** 2, -1)

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1] along path, x [T+1, n] and u [T, m]; S[T] is 0."""

        def back(after: Array, r: Array) -> tuple[Array, Array]:
            now = r + self.discount * after
            return now, now

        to_go = jax.lax.scan(back, jnp.zeros(()), self.rewards(params, path), reverse=True)[1]
        return jnp.append(to_go, 0.0)
