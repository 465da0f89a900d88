"""Q(x, u): the minimum of an ensemble of action values (Fujimoto et al. 2018, eq. (10)).

With `scale` the networks' outputs are in units of the largest return that the rewards so far allow,
rms(reward) / (1 - discount), so that a first step of learning has the size of a value; their last
layer starts at zero. With `normalise` their inputs are states divided by their running standard
deviation in the learner's data.
"""

from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.fields import Count, part
from hybrid_rl.networks import MLP, Activation, Widths, ensemble_apply, ensemble_init
from hybrid_rl.types import Spec


@part
class EnsembleQ:
    """`members` independent action-value networks."""

    hidden: Widths = (256, 256)
    activation: Activation = "relu"
    members: Count = 2
    layer_norm: bool = False  # keeps many updates per decision stable (Hiraoka et al. 2022)
    normalise: bool = False
    scale: bool = False

    def _net(self) -> MLP:
        return MLP(self.hidden, 1, self.activation, self.layer_norm, zero=self.scale)

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial parameters, members on axis 0. The key is consumed."""
        params: dict[str, Any] = {
            "weights": ensemble_init(self._net(), key, self.members, jnp.zeros(spec.n + spec.act))
        }
        if self.normalise:
            params["state"] = statistics.init(spec.n)
        if self.scale:
            params["value"] = statistics.init(1)
        return params

    def observe(self, params: dict[str, Any], x: Array, returns: Array) -> dict[str, Any]:
        """Parameters with statistics updated by states x [B, n] and reward / (1 - discount) [B]."""
        params = statistics.observed(params, x)
        return statistics.observed(params, returns[:, None], "value")

    def all(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """Q of every member [members, ...] at x [..., n] and u [..., m]."""
        xu = jnp.concatenate([statistics.inputs(params, x), u], -1)
        q = ensemble_apply(self._net(), params["weights"], xu)[..., 0]
        return q * jax.lax.stop_gradient(params["value"].magnitude[0]) if self.scale else q

    def value(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """Q [...], the minimum over the members."""
        return self.all(params, x, u).min(0)
