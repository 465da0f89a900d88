"""v ~ pi(x): closed-loop candidates, each drawn at its imagined state (thesis Algorithm 3)."""

from dataclasses import dataclass
from typing import Any

from jax import Array

from hybrid_rl.protocols import Policy
from hybrid_rl.types import Params, Spec


@dataclass(frozen=True)
class PolicyProposal:
    """Candidates from the learned policy."""

    policy: Policy

    def init(self, spec: Spec, quantile: Array) -> tuple[()]:
        """No carry."""
        return ()

    def shaped(self, noise: Array) -> Array:
        """The noise [T, m] itself."""
        return noise

    def __call__(
        self, params: Params, carry: Any, x: Array, plan: Array, noise: Array
    ) -> tuple[Array, Array, Any]:
        """A candidate v [m] ~ pi(x), and log pi(v|x) []; the plan is not used."""
        v, log_prob = self.policy.sample(params.policy, x, noise)
        return v, log_prob, carry
