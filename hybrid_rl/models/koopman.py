"""A Koopman operator: x' = K s(x, u), linear in lifted coordinates x = z(o).

    s = (x, u),   K = [A B]

K is discrete in time, so that it needs no matrix logarithm.
Source: thesis eq. (2.9)-(2.11) and (7.2).
"""

from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import least_squares
from hybrid_rl.fields import Positive, part
from hybrid_rl.protocols import Features
from hybrid_rl.types import Spec


@part
class Koopman:
    """A linear model of `features`."""

    features: Features
    bound: Positive = 1e4  # of |x_i|: predictions of a poor K stay finite

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Features, K [n, r] = [I 0] and its "spread" [r, r]. The key is consumed."""
        features = self.features.init(key, spec)
        n = jax.eval_shape(self.features, features, jnp.zeros(spec.obs)).size
        r = n + spec.act
        return {"features": features, "K": jnp.eye(n, r), "spread": jnp.eye(r)}

    def lift(self, params: dict[str, Any], obs: Array) -> Array:
        """z [n] of an observation [o]."""
        return self.features(params["features"], obs)

    def regressors(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """s [r] at x [n] and u [m]."""
        return jnp.concatenate([x, u])

    def step(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """The next x [n], clipped to the bound."""
        return jnp.clip(params["K"] @ self.regressors(params, x, u), -self.bound, self.bound)

    def std(self, params: dict[str, Any], x: Array) -> Array:
        """Standard deviation [n] of K s at x [n] without action, in units of the noise's."""
        s = self.regressors(params, x, jnp.zeros(params["K"].shape[1] - x.size))
        return jnp.broadcast_to(jnp.sqrt(least_squares.leverage(params["spread"], s)), x.shape)
