"""A share of the candidates from one proposal, the others from another.

Policy and noise combined: noise lets the planner work from the first decisions on, while the policy
is still poor; candidates of the policy dominate where they have higher returns.

All candidates have weights w_k ~ exp(S_k / lambda): their weighted mean estimates the mean
of the distribution proportional to q exp(S / lambda), q = share first + (1 - share) second. This is
Theorem 2 with q instead of the policy pi; Theorem 2 with pi would need the importance ratio pi / q,
which is left out. Planners refuse `log_density` with this proposal, since it would compare the
densities of different distributions.
"""

from typing import Any, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.fields import Fraction, part
from hybrid_rl.protocols import Proposal
from hybrid_rl.types import Params, Spec


@part
class MixtureProposal:
    """The first `share` of the K candidates from `first`, the others from `second`."""

    first: Proposal
    second: Proposal
    share: Fraction = 0.5
    density: ClassVar[bool] = False  # densities of two distributions cannot be compared

    def split(self, quantiles: np.ndarray) -> list[tuple[Proposal, np.ndarray]]:
        """The two proposals, with the quantiles [K] of their candidates."""
        is_first = quantiles < np.float32(self.share)
        return [(self.first, quantiles[is_first]), (self.second, quantiles[~is_first])]

    def init(self, spec: Spec, quantile: Array) -> tuple[Array, Any, Any]:
        """Whether `first` draws this path, and the carries of both."""
        return (
            quantile < self.share,
            self.first.init(spec, quantile),
            self.second.init(spec, quantile),
        )

    def shaped(self, noise: Array) -> tuple[Any, Any]:
        """The noise [T, m] of a path, as each of the two shapes it."""
        return self.first.shaped(noise), self.second.shaped(noise)

    def __call__(
        self, params: Params, carry: tuple[Array, Any, Any], x: Array, plan: Array, noise: Any
    ) -> tuple[Array, Array, tuple[Array, Any, Any]]:
        """A candidate v [m], and its log-density [] under the proposal that drew it."""
        is_first, a, b = carry
        v, log_prob, a = self.first(params, a, x, plan, noise[0])
        other_v, other_log_prob, b = self.second(params, b, x, plan, noise[1])
        v = jnp.where(is_first, v, other_v)
        return v, jnp.where(is_first, log_prob, other_log_prob), (is_first, a, b)
