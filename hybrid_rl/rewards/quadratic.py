"""r = -e' Q e - (u - u_0)' R (u - u_0): a quadratic cost around an equilibrium.

e are the local coordinates of the next state; with a model, e = x' - z(o_0), in its planning
states. Nothing is learned.
"""

from typing import cast

import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import NotNegative, check, part
from hybrid_rl.protocols import Analytic, AnalyticEnv, Balanced, Model
from hybrid_rl.types import Params


@part
class QuadraticReward:
    """Minus the squared distance to the equilibrium, for episodes that do not end."""

    world: Balanced  # an AnalyticEnv, if there is no model
    state_weights: tuple[NotNegative, ...] = (1.0,)  # diagonal of Q: one for all, or the first of e
    action_weights: tuple[NotNegative, ...] = (0.0,)  # diagonal of R: one for all, or [m]
    model: Model | None = None  # e in its planning states; None: in local coordinates

    def __post_init__(self) -> None:
        if self.model is None:
            check(self, "world", Analytic)

    def outcome(self, params: Params, x: Array, u: Array, after: Array) -> tuple[Array, Array]:
        """The reward [] of u [m], which led to `after` [n]; no end."""
        rest, hold = self.world.equilibrium()
        q, r = jnp.array(self.state_weights), jnp.array(self.action_weights)
        if self.model is not None:
            e = after - self.model.lift(params.model, rest.astype(after.dtype))
        else:
            e = cast(AnalyticEnv, self.world).to_local(after[: rest.size])
        if len(q) > 1:
            e = e[: len(q)]
        return -jnp.sum(q * e**2) - jnp.sum(r * (u - hold) ** 2), jnp.full((), -jnp.inf)
