"""A share of the candidates from one proposal, the rest from another.

Policy and noise together: noise lets the planner work from the first decisions on, while the policy
is still wrong; candidates of the policy prevail where they have higher returns.

The candidates are pooled with equal rights, w_k ~ exp(S_k / lambda): the weighted mean estimates
that of the law proportional to q exp(S / lambda), with q = share first + (1 - share) second. That
is Theorem 2 with q instead of the policy pi; the importance ratio pi / q, which would make it
Theorem 2 with pi, is left out. A planner refuses `log_density` here: the densities of
different distributions would be compared.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import jax.numpy as jnp
from jax import Array

from hybrid_rl.protocols import Proposal
from hybrid_rl.types import Params, Spec


@dataclass(frozen=True)
class MixtureProposal:
    """The first `share` of the K candidates from `first`, the others from `second`.

    Raises:
        ValueError: for a share outside [0, 1].
    """

    first: Proposal
    second: Proposal
    share: float = 0.5
    mixed: ClassVar[bool] = True  # its candidates have several distributions

    def __post_init__(self) -> None:
        """Check the fields."""
        if not 0 <= self.share <= 1:
            raise ValueError(f"proposal.share={self.share}: must lie in [0, 1]")

    def init(self, spec: Spec, quantile: Array) -> tuple[Array, Any, Any]:
        """Which proposal draws this path, and the carries of both."""
        return (
            quantile < self.share,
            self.first.init(spec, quantile),
            self.second.init(spec, quantile),
        )

    def __call__(
        self, params: Params, carry: tuple[Array, Any, Any], x: Array, plan: Array, noise: Array
    ) -> tuple[Array, Array, tuple[Array, Any, Any]]:
        """V [m] and its log-density [] under the one that drew it."""
        ours, a, b = carry
        v, log_prob, a = self.first(params, a, x, plan, noise)
        other_v, other_log_prob, b = self.second(params, b, x, plan, noise)
        v, log_prob = jnp.where(ours, v, other_v), jnp.where(ours, log_prob, other_log_prob)
        return v, log_prob, (ours, a, b)
