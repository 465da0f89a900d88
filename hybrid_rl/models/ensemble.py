"""Several models of one world, alike but for their first weights: where they differ, none knows.

    step = mean_i f_i(x, u),   draw = one member's prediction with its noise

Deep ensembles (Lakshminarayanan et al. 2017), as model-based learning uses them (Chua et al.
2018, Janner et al. 2019).
"""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import Spec


@dataclass(frozen=True)
class Ensemble:
    """`members` copies of `model`, whose parameters hold "weights" beside shared statistics.

    Raises:
        ValueError: for a count that is not a positive whole number.
    """

    model: Any
    members: int = 5

    def __post_init__(self) -> None:
        """Check the fields."""
        if not isinstance(self.members, int) or self.members < 1:
            raise ValueError(f"model.members={self.members}: must be a whole number, 1 or more")

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """First parameters; weights lead with [members]. The key is consumed."""
        keys = jax.random.split(key, self.members)
        weights = jax.vmap(lambda k: self.model.init(k, spec)["weights"])(keys)
        return {**self.model.init(key, spec), "weights": weights}

    def observe(self, params: dict[str, Any], x: Array, next_x: Array) -> dict[str, Any]:
        """Parameters whose statistics have seen x and next_x [B, n]."""
        return self.model.observe(params, x, next_x)

    def lift(self, params: dict[str, Any], obs: Array) -> Array:
        """The planning state of an observation [o]."""
        return self.model.lift(params, obs)

    def each(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """What every member predicts [members, n]."""
        return self._over(self.model.step, params, x, u)

    def step(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """Mean over the members [n]."""
        return self.each(params, x, u).mean(0)

    def draw(self, params: dict[str, Any], x: Array, u: Array, noise: Array, place: Array) -> Array:
        """A next state [n] of one member: that at `place` [] in [0, 1) of the row."""
        which = jnp.int32(place * self.members)
        weights = jax.tree.map(lambda w: w[which], params["weights"])
        return self.model.draw({**params, "weights": weights}, x, u, noise, place)

    def loss(self, params: dict[str, Any], x: Array, u: Array, next_x: Array) -> Array:
        """Mean over the members []."""
        return self._over(self.model.loss, params, x, u, next_x).mean()

    def _over(self, of_member: Any, params: dict[str, Any], *inputs: Array) -> Array:
        """Outputs of all members [members, ...]."""
        weights = params["weights"]
        return jax.vmap(lambda w: of_member({**params, "weights": w}, *inputs))(weights)
