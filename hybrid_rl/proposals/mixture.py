"""A share of the candidates from one proposal, the others from another.

Policy and noise combined: noise lets the planner work from the first decisions on, while the policy
is still poor; candidates of the policy dominate where they have higher returns.

All candidates have weights w_k ~ exp(S_k / lambda): their weighted mean estimates the mean
of the distribution proportional to q exp(S / lambda), q = share first + (1 - share) second. This is
Theorem 2 with q instead of the policy pi; Theorem 2 with pi would need the importance ratio pi / q,
which is left out. Planners refuse `log_density` with this proposal, since it would compare the
densities of different distributions.
"""

from typing import ClassVar

import numpy as np

from hybrid_rl.fields import Fraction, part
from hybrid_rl.protocols import Proposal


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
