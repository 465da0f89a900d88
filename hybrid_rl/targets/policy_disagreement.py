"""p(s) ~ the variance of the actions that several clones of a teacher choose at s.

    p(s) ~ sum_i var_j pi_ji(s) + floor,   j: clones, i: entries of the action

Source: the doubt of EnsembleDAgger (Menda, Driggs-Campbell and Kochenderfer 2019), which decides
there who acts; as a choice of queries it is query by committee (Seung, Opper and Sompolinsky 1992).
"""

from typing import Annotated, Any, cast

import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Positive, has, part
from hybrid_rl.protocols import LearnedPolicy
from hybrid_rl.types import Params


@part
class PolicyDisagreement:
    """Proportional to the variance of the clones' actions."""

    policy: Annotated[LearnedPolicy, has("each", "needs policy=clones")]
    floor: Positive = 1e-8  # of the variance

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at the planning state s [n], up to a constant."""
        return jnp.log(cast(Any, self.policy).each(params.policy, s).var(0).sum() + self.floor)
