"""v = clip(a + e), e_t = c e_{t-1} + sqrt(1 - c^2) s N(0, 1): noise around the plan.

The proposals of MPPI (Williams et al. 2017); c > 0 colours them.
"""

from dataclasses import dataclass

import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import Params, Spec


@dataclass(frozen=True)
class NoiseProposal:
    """Candidates around the warm-started plan.

    Raises:
        ValueError: for a deviation that is not positive or a colour outside [0, 1).
    """

    std: float = 0.3  # of full actuation
    colour: float = 0.0  # correlation of neighbours in time

    def __post_init__(self) -> None:
        """Check the fields."""
        if self.std <= 0:
            raise ValueError(f"proposal.std={self.std}: must be positive")
        if not 0 <= self.colour < 1:
            raise ValueError(f"proposal.colour={self.colour}: must lie in [0, 1)")

    def init(self, spec: Spec, place: Array) -> Array:
        """No noise [m] before the first action."""
        return jnp.zeros(spec.act)

    def __call__(
        self, params: Params, carry: Array, x: Array, plan: Array, noise: Array
    ) -> tuple[Array, Array, Array]:
        """V [m] around plan [m] and the log-density of its deviation."""
        noise = self.colour * carry + jnp.sqrt(1 - self.colour**2) * self.std * noise
        log_prob = jnp.sum(-0.5 * (noise / self.std) ** 2 - jnp.log(self.std * 2.5066283))
        return jnp.clip(plan + noise, -1, 1), log_prob, noise
