"""Go to the maximum of p(s): Bayesian optimisation, with a robot or without dynamics.

    s* = argmax_i log p(s_i),   s_i ~ U(S);   a new goal every `every` decisions

With a stabilizing policy, s* is its goal, and the robot measures at its actual position
(LQR-Bayesian optimisation). Without one the action is s* itself, scaled to [-1, 1], for an
environment without dynamics. Source: thesis section 6.3.1 and Algorithm 1.

With `ahead` T > 0 the target instead values the way to s_i: its T positions on a straight line,
the last one s_i (thesis section 5.3.1).
"""

from typing import Any, NamedTuple, cast

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.domain import Box
from hybrid_rl.fields import Count, FieldError, Natural, Positive, part
from hybrid_rl.protocols import StabilizingPolicy, Target
from hybrid_rl.types import Params, Spec


class GoalState(NamedTuple):
    """The current goal."""

    s: Array  # [v]
    age: Array  # [] decisions since it was chosen; 0: choose a new one


@part
class GoalController:
    """Drives to the maximum of a target."""

    target: Target  # with `ahead` one that has `along`
    domain: Box
    policy: StabilizingPolicy | None = None  # None: the action is the goal
    samples: Count = 1000  # N candidates
    every: Count = 20  # [decisions]
    near: Positive | None = None  # distance at which a new goal is chosen; None: only every `every`
    ahead: Natural = 0  # T positions on the way to a candidate; 0: the candidate alone

    def __post_init__(self) -> None:
        if self.ahead and getattr(self.target, "along", None) is None:
            words = "this target cannot score a path; use target=entropy_reduction"
            raise FieldError(self, "ahead", words)

    def init(self, spec: Spec) -> GoalState:
        """No goal yet."""
        return GoalState(jnp.zeros(self.domain.size), jnp.zeros((), jnp.int32))

    def act(
        self, params: Params, state: GoalState, obs: Array, key: Array
    ) -> tuple[Array, GoalState, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        s = self.domain.sample(self.samples, key)
        best = s[jnp.argmax(self._values(params, self.domain.of(obs), s))]
        due = state.age == 0
        if self.near is not None:
            due = due | (jnp.linalg.norm(self.domain.of(obs) - state.s) < self.near)
        goal = jnp.where(due, best, state.s)
        after = GoalState(goal, (jnp.where(due, 0, state.age) + 1) % self.every)
        if self.policy is None:
            low, high = jnp.array(self.domain.low), jnp.array(self.domain.high)
            return 2 * (goal - low) / (high - low) - 1, after, {}
        rest = self.policy.world.equilibrium()[0].astype(obs.dtype)
        metrics = {"planner/lyapunov": self.policy.lyapunov(obs)}
        return self.policy.towards(obs, self.domain.put(rest, goal)), after, metrics

    def _values(self, params: Params, start: Array, s: Array) -> Array:
        """The value [N] of each candidate s [N, v], or of the way to it from `start` [v]."""
        if not self.ahead:
            return jax.vmap(self.target.log_density, (None, 0))(params, s)
        steps = jnp.arange(1, self.ahead + 1)[None, :, None] / self.ahead
        ways = start[None, None] + steps * (s - start[None])[:, None]
        return jax.vmap(cast(Any, self.target).along, (None, 0))(params, ways)

    def greedy(self) -> "GoalController":
        """The same controller: it has no exploration noise."""
        return self
