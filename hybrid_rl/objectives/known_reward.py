"""J(path) = sum_t c^t r(x_t, u_t, x_{t+1}): the return of an environment's own reward function.

The dynamics may be learned; the reward is known.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import analytic, returns
from hybrid_rl.protocols import RewardedEnv
from hybrid_rl.types import Params, Path, Return, Spec


@dataclass(frozen=True)
class KnownReward:
    """The discounted sum of the environment's reward along a path.

    Raises:
        ValueError: for an environment whose reward is not a function of observations and action,
            or a discount outside (0, 1].
    """

    world: RewardedEnv
    discount: float = 1.0  # c, per decision

    def __post_init__(self) -> None:
        """Check the fields."""
        analytic.require_reward("objective", self.world)
        if not 0 < self.discount <= 1:
            raise ValueError(f"objective.discount={self.discount}: must lie in (0, 1]")

    def init(self, spec: Spec) -> tuple[()]:
        """No memory."""
        return ()

    def prepare(
        self, params: Params, memory: tuple[()], x: Array, u_before: Array, key: Array
    ) -> tuple[Return, tuple[()]]:
        """J of a path; the key is not used."""
        return lambda path: self.reward_to_go(params, path)[0], memory

    def rewards(self, params: Params, path: Path) -> Array:
        """r [T] along path, x [T+1, n] and u [T, m]."""
        o = self.world.spec.obs
        x = path.x[:, :o]
        return jax.vmap(self.world.reward_of)(x[:-1], path.u, x[1:])

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1] along path, x [T+1, n] and u [T, m]; S[T] is 0."""
        rewards = self.rewards(params, path)
        return returns.to_go(rewards, jnp.full(rewards.shape, self.discount), jnp.zeros(()))
