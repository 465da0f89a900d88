"""J = sum_t 1/2 sum_i log(1 + s_i^2 / sigma^2): the disagreement s of an ensemble's members.

It is the information of measuring the transition (x_t, u_t) if the members are samples of the
model's posterior and their predictions are Gaussian with noise sigma. Source: Sukhija et al. 2023,
Optimistic Active Exploration of Dynamical Systems, there with learned noise; Shyam et al. 2019.
"""

from typing import Annotated, Any, cast

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.returns import Summed
from hybrid_rl.fields import Positive, has, part
from hybrid_rl.protocols import Model
from hybrid_rl.types import Params, Path


@part
class Disagreement(Summed):
    """Expected information about an ensemble of models along a path."""

    model: Annotated[Model, has("disagreement", "needs an ensemble; choose model=ensemble")]
    noise: Positive = 0.1  # sigma, in running standard deviations of the change

    def rewards(self, params: Params, path: Path) -> Array:
        """Information [T] of each decision of path, x [T+1, n] and u [T, m]."""
        std = jax.vmap(cast(Any, self.model).disagreement, (None, 0, 0))(
            params.model, path.x[:-1], path.u
        )
        return 0.5 * jnp.sum(jnp.log1p((std / self.noise) ** 2), -1)
