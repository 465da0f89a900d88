"""p(s) ~ c(I(s)): the Fisher information of a demonstration at s about a policy's weights.

    I(s) = diag(sum_i sigma^-2 (d mu_i / d theta)^2)  [P],   mu: the policy before squashing

    trace    c = tr I(s) = sum_j I_j
    inverse  c = 1 / sum_j 1 / (I_j + floor)
    gain     c = sum_j log(1 + I_j / (B_j + floor)),   B: information of the labels so far

`gain` is twice the information that the answer adds, with a diagonal prior `floor`. Behind tanh
the derivatives vanish where an action is saturated, so they are taken before it. Source: thesis
eq. (4.5)-(4.6) (`inverse`) and (6.28) (`trace`), with sigma^-2 where (6.28) has sigma^-1; `gain`
is ours.
"""

from typing import Annotated, Any, Literal, cast

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import fisher
from hybrid_rl.core.domain import Box
from hybrid_rl.fields import Positive, check, has, part
from hybrid_rl.networks import precision
from hybrid_rl.protocols import Balanced, BalancedEnv, LearnedPolicy
from hybrid_rl.types import Params


@part
class PolicyInformation:
    """Proportional to a criterion of the information that a demonstration has.

    Without a domain s is a planning state; with one, the coordinates that it lacks have their
    equilibrium values.
    """

    policy: Annotated[LearnedPolicy, has("unsquashed", "needs policy=deterministic")]
    world: BalancedEnv | None = None  # of the equilibrium
    domain: Box | None = None
    criterion: Literal["trace", "inverse", "gain"] = "gain"  # c
    sigma: Positive = 1.0  # of mu
    floor: Positive = 0.01  # [1/weight^2]

    def __post_init__(self) -> None:
        if self.domain is not None:
            check(self, "world", Balanced)

    def information(self, params: Params, x: Array) -> Array:
        """I(x) [P] at the planning state x [n]."""
        mu, own = cast(Any, self.policy).unsquashed, params.policy
        with precision.using("float32"):
            F = fisher.jacobian(lambda weights: mu({**own, "weights": weights}, x), own["weights"])
        return fisher.diagonal(F, jnp.full(len(F), self.sigma))

    def evidence(self, params: Params, x: Array) -> Array | None:
        """What params.labels sums over the labels: I(x) [P] for `gain`, else nothing."""
        return self.information(params, x) if self.criterion == "gain" else None

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at s [v], up to a constant; `gain` needs params.labels."""
        x = s
        if self.domain is not None:
            assert self.world is not None
            x = self.domain.put(self.world.equilibrium()[0].astype(s.dtype), s)
        here = self.information(params, x)
        if self.criterion == "trace":
            return jnp.log(jnp.sum(here))
        if self.criterion == "inverse":
            return -jnp.log(jnp.sum(1 / (here + self.floor)))
        before = params.labels.evidence + self.floor
        return jnp.log(jnp.sum(jnp.log1p(here / before)))
