"""u = pi(x): act by the learned policy, without planning.

With `hold` above 1 the noise of a sample is held for n decisions, p(n) ~ n^-2 for n up to `hold`:
most noise lasts one decision and some lasts long, which explores further than white noise
(Dabney et al. 2021; FlashSAC, Kim et al. 2026, with 16).
"""

from dataclasses import replace
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.lifting import lift
from hybrid_rl.fields import Count, part
from hybrid_rl.protocols import Model, Policy
from hybrid_rl.types import Params, Spec


class Held(NamedTuple):
    """Noise that is held."""

    noise: Array  # [m]
    left: Array  # [] decisions for which it still holds


@part
class PolicyController:
    """Actions of the policy: samples if `explore` is true, else its mean."""

    policy: Policy
    model: Model | None = None  # lifts observations to planning states; None: they are the same
    explore: bool = True
    hold: Count = 1  # [decisions] longest that noise is held

    def init(self, spec: Spec) -> tuple:
        """No noise; without `hold`, no state."""
        if not self.explore or self.hold == 1:
            return ()
        return Held(jnp.zeros(spec.act), jnp.zeros((), jnp.int32))

    def act(
        self, params: Params, state: tuple, obs: Array, key: Array
    ) -> tuple[Array, tuple, dict[str, Array]]:
        """Action [m]. The key is consumed."""
        x = lift(self.model, params.model, obs)
        mean = self.policy.mean(params.policy, x)
        if not self.explore:
            return mean, state, {}
        if self.hold > 1:
            state = self._next(state, key)
            return self.policy.sample(params.policy, x, state.noise)[0], state, {}
        noise = jax.random.normal(key, mean.shape)
        return self.policy.sample(params.policy, x, noise)[0], state, {}

    def _next(self, state: tuple, key: Array) -> Held:
        """The noise of this decision. The key is consumed."""
        drawing, lasting = jax.random.split(key)
        held, fresh = Held(*state), jax.random.normal(drawing, state[0].shape)
        lengths = jnp.arange(1, self.hold + 1)
        length = 1 + jax.random.categorical(lasting, -2 * jnp.log(lengths))
        over = held.left == 0
        left = jnp.where(over, length, held.left) - 1
        return Held(jnp.where(over, fresh, held.noise), left.astype(jnp.int32))

    def greedy(self) -> "PolicyController":
        """The controller that acts by the mean."""
        return replace(self, explore=False)
