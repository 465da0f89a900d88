"""J = sum_t 1/2 sum_i log(1 + s_i^2 / sigma^2): the disagreement s of an ensemble's members.

It is the information of measuring the transition (x_t, u_t) if the members are samples of the
model's posterior and their predictions are Gaussian with noise sigma. Source: Sukhija et al. 2023,
Optimistic Active Exploration of Dynamical Systems, there with learned noise; Shyam et al. 2019.
"""

from typing import Annotated, Any, cast

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Positive, has, part
from hybrid_rl.protocols import Model
from hybrid_rl.types import Params, Path, Return, Spec


@part
class Disagreement:
    """Expected information about an ensemble of models along a path."""

    model: Annotated[Model, has("disagreement", "needs an ensemble; choose model=ensemble")]
    noise: Positive = 0.1  # sigma, in running standard deviations of the change

    def init(self, spec: Spec) -> tuple[()]:
        """No memory: what the data say is in the model's parameters."""
        return ()

    def prepare(
        self, params: Params, memory: tuple[()], x: Array, u_before: Array, key: Array
    ) -> tuple[Return, tuple[()]]:
        """J [nat] of a path; the key is not used."""
        return lambda path: self.rewards(params, path).sum(), memory

    def rewards(self, params: Params, path: Path) -> Array:
        """Information [T] of each decision of path, x [T+1, n] and u [T, m]."""
        std = jax.vmap(cast(Any, self.model).disagreement, (None, 0, 0))(
            params.model, path.x[:-1], path.u
        )
        return 0.5 * jnp.sum(jnp.log1p((std / self.noise) ** 2), -1)

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1] along path, x [T+1, n] and u [T, m]; S[T] is 0."""
        to_go = jnp.cumsum(self.rewards(params, path)[::-1])[::-1]
        return jnp.append(to_go, 0.0)
