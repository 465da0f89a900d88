"""u = pi(x): act from what was learned, without planning."""

from dataclasses import dataclass, replace

import jax
from jax import Array

from hybrid_rl.types import Params, Policy, Spec


@dataclass(frozen=True)
class PolicyController:
    """The policy alone: samples while it learns, its mean when `explore` is off."""

    policy: Policy
    explore: bool = True

    def init(self, spec: Spec) -> tuple[()]:
        """Nothing is kept."""
        return ()

    def act(
        self, params: Params, state: tuple[()], obs: Array, key: Array
    ) -> tuple[Array, tuple[()], dict[str, Array]]:
        """Action [m]. The key is consumed."""
        mean = self.policy.mean(params.policy, obs)
        if self.explore:
            noise = jax.random.normal(key, mean.shape)
            return self.policy.sample(params.policy, obs, noise)[0], state, {}
        return mean, state, {}

    def greedy(self) -> "PolicyController":
        """The mean."""
        return replace(self, explore=False)
