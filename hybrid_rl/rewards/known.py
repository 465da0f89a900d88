"""r(x, u, x') is a known function of observations and action: nothing is learned.

It is that of the environment, or another goal, a class with a method `reward_of`. The dynamics may
be learned. With `ends`, a reward part that predicts them, nothing is expected after an end.
"""

from typing import cast

import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import check, part
from hybrid_rl.protocols import Env, Goal, Reward, Rewarded
from hybrid_rl.types import Params


@part
class KnownReward:
    """The reward of `goal`, or that of `world`."""

    world: Env
    goal: Goal | None = None  # None: the environment's own reward
    ends: Reward | None = None  # predicts ends; None: episodes do not end

    def __post_init__(self) -> None:
        if self.goal is None:
            check(self, "world", Rewarded)

    def outcome(self, params: Params, x: Array, u: Array, after: Array) -> tuple[Array, Array]:
        """The reward [] of u [m] at x [n], and the logit [] of the episode ending there.

        The first entries of x and of `after` [n] are the observation.
        """
        o, pays = self.world.spec.obs, cast(Goal, self.world if self.goal is None else self.goal)
        reward = getattr(pays, "smoothed", pays.reward_of)(x[:o], u, after[:o])
        if self.ends is None:
            return reward, jnp.full((), -jnp.inf)
        return reward, self.ends.outcome(params, x, u, after)[1]
