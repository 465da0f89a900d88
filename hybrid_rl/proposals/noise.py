"""v = clip(a + e), e_0 ~ N(0, s^2), e_t ~ N(c e_{t-1}, (1 - c^2) s^2): noise around the plan.

e is stationary: its standard deviation is s at each decision, also at the first, which is
executed. c = 0 gives the candidates of MPPI without its control cost (Williams et al. 2017,
alpha = 1); c > 0 correlates them in time.
"""

import math
from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Discount, Positive, part
from hybrid_rl.types import Params, Spec


class NoiseState(NamedTuple):
    """The noise of the previous decision."""

    e: Array  # [m]
    correlation: Array  # [] with the next noise; 0 before the first decision


@part
class NoiseProposal:
    """Candidates around the warm-started plan."""

    std: Positive = 0.3  # of full actuation
    correlation: Discount = 0.0  # of the noise of successive decisions

    def init(self, spec: Spec, quantile: Array) -> NoiseState:
        """No noise before the first action."""
        return NoiseState(jnp.zeros(spec.act), jnp.zeros(()))

    def shaped(self, noise: Array) -> Array:
        """The noise [T, m] itself."""
        return noise

    def __call__(
        self, params: Params, carry: NoiseState, x: Array, plan: Array, noise: Array
    ) -> tuple[Array, Array, NoiseState]:
        """A candidate v [m] around plan [m], and log p(e_t | e_{t-1}) [] of its unclipped noise."""
        share = 1 - carry.correlation**2  # of the variance that is new
        new = jnp.sqrt(share) * self.std * noise
        log_prob = -0.5 * (new / self.std) ** 2 / share - jnp.log(self.std * math.sqrt(2 * math.pi))
        log_prob = jnp.sum(log_prob - 0.5 * jnp.log(share))
        e = carry.correlation * carry.e + new
        return jnp.clip(plan + e, -1, 1), log_prob, NoiseState(e, jnp.full((), self.correlation))
