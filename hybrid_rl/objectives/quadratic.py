"""J = -sum_t e_{t+1}' Q e_{t+1} + (u_t - u_0)' R (u_t - u_0): a quadratic cost around equilibrium.

e are the environment's local coordinates; with a model, e = x - z(o_0), in its planning states. The
return is known: nothing is learned.
"""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import analytic, returns
from hybrid_rl.protocols import Model
from hybrid_rl.types import Params, Path, Return, Spec


@dataclass(frozen=True)
class Quadratic:
    """Minus the squared distance to the equilibrium, summed along a path.

    Raises:
        ValueError: for an environment that is not analytic, one without an equilibrium if there is
            a model, or weights below 0.
    """

    world: Any  # an AnalyticEnv; with a model, a BalancedEnv
    state_weights: tuple[float, ...] = (1.0,)  # diagonal of Q: one for all, or the first of e
    action_weights: tuple[float, ...] = (0.0,)  # diagonal of R: one for all, or [m]
    discount: float = 1.0  # per decision
    model: Model | None = None  # e in its planning states; None: in local coordinates

    def __post_init__(self) -> None:
        """Check the fields."""
        if self.model is None:
            analytic.require("objective", self.world)
        else:
            analytic.require_equilibrium("objective", self.world)
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
        q, r = jnp.array(self.state_weights), jnp.array(self.action_weights)
        if self.model is None:
            e = jax.vmap(self.world.to_local)(path.x[1:, : rest.size])
        else:
            e = path.x[1:] - self.model.lift(params.model, rest.astype(path.x.dtype))[None]
        if len(q) > 1:
            e = e[:, : len(q)]
        return -jnp.sum(q[None] * e**2, -1) - jnp.sum(r[None] * (path.u - hold[None]) ** 2, -1)

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1] along path, x [T+1, n] and u [T, m]; S[T] is 0."""
        rewards = self.rewards(params, path)
        return returns.to_go(rewards, jnp.full(rewards.shape, self.discount), jnp.zeros(()))
