"""v ~ s pi(x): closed-loop candidates, each drawn at its imagined state (thesis Algorithm 3).

With several `strengths` s the candidates are divided among them: a robot that runs slower than its
policy is closer to a weaker policy than to noise. `quiet` candidates have no noise.
"""

from typing import Annotated, Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import FILLED, Fraction, Positive, part
from hybrid_rl.protocols import Policy
from hybrid_rl.types import Params, Spec


@part
class PolicyProposal:
    """Candidates from the learned policy."""

    policy: Policy
    strengths: Annotated[tuple[Positive, ...], FILLED] = (1.0,)  # factors on actions
    quiet: Fraction = 0.0  # share of the candidates, of each strength, that act by the mean

    @property
    def _plain(self) -> bool:
        return self.strengths == (1.0,) and not self.quiet

    def init(self, spec: Spec, quantile: Array) -> tuple:
        """The factors on the actions and on the noise of a path; without strengths, no carry."""
        if self._plain:
            return ()
        position = quantile * len(self.strengths)
        number = jnp.floor(position).astype(jnp.int32)
        return jnp.array(self.strengths)[number], (position - number >= self.quiet).astype(
            jnp.float32
        )

    def shaped(self, noise: Array) -> Array:
        """The noise [T, m] itself."""
        return noise

    def __call__(
        self, params: Params, carry: Any, x: Array, plan: Array, noise: Array
    ) -> tuple[Array, Array, Any]:
        """A candidate v [m] ~ pi(x), and log pi(v|x) [] before its factor; the plan is not used."""
        if self._plain:
            return *self.policy.sample(params.policy, x, noise), carry
        strength, loud = carry
        v, log_prob = self.policy.sample(params.policy, x, loud * noise)
        return strength * v, log_prob, carry
