"""Go to the greatest of p(s): Bayesian optimisation, with a robot or without.

    s* = argmax_i log p(s_i),   s_i ~ U(S);   a new goal every `every` decisions

With an equilibrium policy, the robot is told to rest at s*, and measures wherever it is by then
(LQR-Bayesian optimisation). Without one the action is s* itself, scaled to [-1, 1], for a world
that is anywhere at once. Source: thesis section 6.3.1 and Algorithm 1.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import ergodic
from hybrid_rl.types import Params, Spec, Target


class Goal(NamedTuple):
    """Where to."""

    s: Array  # [v]
    age: Array  # [] decisions since it was chosen; 0: choose


@dataclass(frozen=True)
class GoalController:
    """Goes to where the target is greatest.

    Raises:
        ValueError: for a box that is none, or counts that are not positive.
    """

    target: Target
    policy: Any = None  # offers `towards`, `lyapunov` and a world; None: no robot
    coordinates: tuple[int, ...] = (0,)  # of the observation, [v]
    low: tuple[float, ...] = (-1.0,)
    high: tuple[float, ...] = (1.0,)
    samples: int = 1000  # N candidates
    every: int = 20  # [decisions]

    def __post_init__(self) -> None:
        """Check the fields."""
        for name in ("coordinates", "low", "high"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        ergodic.box("acquirer", self.coordinates, self.low, self.high)
        if self.samples < 1 or self.every < 1:
            raise ValueError("acquirer: samples and every must be 1 or more")

    def init(self, spec: Spec) -> Goal:
        """None chosen."""
        return Goal(jnp.zeros(len(self.low)), jnp.zeros((), jnp.int32))

    def act(
        self, params: Params, state: Goal, obs: Array, key: Array
    ) -> tuple[Array, Goal, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        s = ergodic.uniform(self.low, self.high, self.samples, key)
        best = s[jnp.argmax(jax.vmap(self.target.log_density, (None, 0))(params, s))]
        goal = jnp.where(state.age == 0, best, state.s)
        after = Goal(goal, (state.age + 1) % self.every)
        if self.policy is None:
            low, high = jnp.array(self.low), jnp.array(self.high)
            return 2 * (goal - low) / (high - low) - 1, after, {}
        rest = self.policy.world.equilibrium()[0].astype(obs.dtype)
        there = rest.at[jnp.array(self.coordinates)].set(goal)
        seen = {"planner/lyapunov": self.policy.lyapunov(obs)}
        return self.policy.towards(obs, there), after, seen

    def greedy(self) -> "GoalController":
        """It draws no noise."""
        return self
