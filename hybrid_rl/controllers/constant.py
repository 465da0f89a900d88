"""u = constant: motor babble with noise around it, and nothing else without."""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Signed, part
from hybrid_rl.types import Params, Spec


@part
class ConstantController:
    """The same action at every decision."""

    action: Signed = 0.0  # of every actuator

    def init(self, spec: Spec) -> Array:
        """The action [m]."""
        return jnp.full(spec.act, self.action)

    def act(
        self, params: Params, state: Array, obs: Array, key: Array
    ) -> tuple[Array, Array, dict[str, Array]]:
        """The action [m]."""
        return state, state, {}

    def greedy(self) -> "ConstantController":
        """The same controller."""
        return self
