"""p(s) ~ the information that a label at s adds about the last layer of a policy.

    p(s) ~ log(1 + phi' (sum_i phi_i phi_i' + floor I)^-1 phi),   phi = (features of s, 1)

The last layer is linear in its weights, so this is twice the expected information gain of Bayesian
linear regression over the labels so far, with the features as they are (MacKay 1992).
"""

from dataclasses import dataclass

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.solving import solve
from hybrid_rl.protocols import UnsquashedPolicy
from hybrid_rl.types import Params


@dataclass(frozen=True)
class FeatureInformation:
    """Proportional to the information gain about the last layer.

    Raises:
        ValueError: for a policy without features, or a floor that is not positive.
    """

    policy: UnsquashedPolicy
    floor: float = 1.0  # prior information of each weight

    def __post_init__(self) -> None:
        """Check the fields."""
        if not hasattr(self.policy, "layers"):
            kind = type(self.policy).__name__
            raise ValueError(f"target.policy={kind}: needs policy=deterministic")
        if not self.floor > 0:
            raise ValueError(f"target.floor={self.floor}: must be above 0")

    def _features(self, params: Params, x: Array) -> Array:
        """phi [h + 1] at x [n]."""
        return jnp.append(self.policy.layers(params.policy, x)[0], 1.0)

    def evidence(self, params: Params, x: Array) -> Array:
        """phi phi' [h + 1, h + 1] at x [n]."""
        phi = self._features(params, x)
        return jnp.outer(phi, phi)

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at the planning state s [n], up to a constant."""
        phi, before = self._features(params, s), params.belief.evidence
        covariance = solve(before + self.floor * jnp.eye(phi.size), jnp.eye(phi.size))
        return jnp.log(jnp.log1p(jnp.maximum(phi @ covariance @ phi, 1e-12)))
