"""z = (y, net(y)): features of an observation that are learned.

y are coordinates of the observation. They are part of z, since a network alone can make any linear
model exact by z = 0. Source: thesis section 7.4, eq. (7.12).
"""

from typing import Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.lifting import check_coordinates, select
from hybrid_rl.fields import Count, part
from hybrid_rl.networks import MLP, Activation, Widths, apply, precision
from hybrid_rl.types import Spec


@part
class Network:
    """Coordinates of the observation, and `size` outputs of a network."""

    coordinates: tuple[int, ...] | None = None  # of the observation; None: all
    size: Count = 40  # outputs of the network
    hidden: Widths = (20,)
    activation: Activation = "tanh"

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial weights. The key is consumed."""
        check_coordinates("features.coordinates", self.coordinates, spec.obs)
        y = select(jnp.zeros(spec.obs), self.coordinates)
        return {"weights": self._net.init(key, y)}

    @property
    def _net(self) -> MLP:
        return MLP(self.hidden, self.size, self.activation)

    def __call__(self, params: dict[str, Any], obs: Array) -> Array:
        """z [n] of an observation [o]."""
        y = select(obs, self.coordinates)
        with precision.using("float32"):  # least squares follow
            z = apply(self._net, params["weights"], y)
        return jnp.concatenate([y, z])
