"""p(s) ~ exp(c UCB(s)), UCB = mean + kappa std of a belief (thesis eq. 6.20-6.21)."""

from jax import Array

from hybrid_rl.fields import Positive, part
from hybrid_rl.protocols import Belief
from hybrid_rl.types import Params


@part
class UpperConfidenceBound:
    """Proportional to the exponential of the upper confidence bound."""

    belief: Belief
    kappa: Positive = 2.0
    sharpness: Positive = 10.0  # c [1/phi]

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at s [v], up to a constant."""
        mean, std = self.belief.predict(params.belief, s)
        return self.sharpness * (mean + self.kappa * std)
