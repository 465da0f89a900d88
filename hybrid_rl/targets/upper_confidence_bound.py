"""p(s) ~ exp(c UCB(s)), UCB = mean + kappa std of a belief (thesis eq. 6.20-6.21)."""

from dataclasses import dataclass

from jax import Array

from hybrid_rl.core.ranges import above_zero
from hybrid_rl.protocols import Belief
from hybrid_rl.types import Params


@dataclass(frozen=True)
class UpperConfidenceBound:
    """Proportional to the exponential of the upper confidence bound.

    Raises:
        ValueError: for constants that are not positive.
    """

    belief: Belief
    kappa: float = 2.0
    sharpness: float = 10.0  # c [1/phi]

    def __post_init__(self) -> None:
        """Check the fields."""
        above_zero(self, "target", "kappa", "sharpness")

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at s [v], up to a constant."""
        mean, std = self.belief.predict(params.belief, s)
        return self.sharpness * (mean + self.kappa * std)
