"""u = pi(x): act by the learned policy, without planning."""

from dataclasses import dataclass, replace

import jax
from jax import Array

from hybrid_rl.core.lifting import lift
from hybrid_rl.protocols import Model, Policy
from hybrid_rl.types import Params, Spec


@dataclass(frozen=True)
class PolicyController:
    """Actions of the policy: samples if `explore` is true, else its mean."""

    policy: Policy
    model: Model | None = None  # lifts observations to planning states; None: they are the same
    explore: bool = True

    def init(self, spec: Spec) -> tuple[()]:
        """No state."""
        return ()

    def act(
        self, params: Params, state: tuple[()], obs: Array, key: Array
    ) -> tuple[Array, tuple[()], dict[str, Array]]:
        """Action [m]. The key is consumed."""
        x = lift(self.model, params.model, obs)
        mean = self.policy.mean(params.policy, x)
        if self.explore:
            noise = jax.random.normal(key, mean.shape)
            return self.policy.sample(params.policy, x, noise)[0], state, {}
        return mean, state, {}

    def greedy(self) -> "PolicyController":
        """The controller that acts by the mean."""
        return replace(self, explore=False)
