"""u = u' if V(f(x, u')) <= level else pi(x): a controller inside a level set of V.

u' is the action of any controller, pi a stabilizing policy and V its Lyapunov function. Source: the
set C of thesis Definition 4.
"""

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.protocols import Controller, Model, StabilizingPolicy
from hybrid_rl.types import Params, Spec


@dataclass(frozen=True)
class GuardedController:
    """`controller`, replaced by `policy` where its action would leave the level set."""

    controller: Controller
    model: Model  # predicts the next state
    policy: StabilizingPolicy
    level: float | None = None  # of V; None: no guard

    def init(self, spec: Spec) -> Any:
        """The initial state of the inner controller."""
        return self.controller.init(spec)

    def act(
        self, params: Params, state: Any, obs: Array, key: Array
    ) -> tuple[Array, Any, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        u, state, metrics = self.controller.act(params, state, obs, key)
        if self.level is None:
            return u, state, metrics
        x = self.model.lift(params.model, obs)
        step = partial(self.model.step, params.model)
        out = self.policy.lyapunov(step(x, u)) > self.level
        u = jnp.where(out, jnp.clip(self.policy.mean(params.policy, x), -1, 1), u)
        return u, state, {**metrics, "planner/handed_over": out.astype(jnp.float32)}

    def greedy(self) -> "GuardedController":
        """The same guard around the controller without exploration."""
        return replace(self, controller=self.controller.greedy())
