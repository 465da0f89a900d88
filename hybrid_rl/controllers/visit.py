"""Go to the most uncertain state nearby: `controller` acts with it as its goal.

    goal = argmax_i |std f(x_i)|,   x_i = z(o + e_i),  e_i ~ U(-radius, radius)^o

With a Koopman model in z, whose variance is s' S s, this is active learning by a Gaussian process
with the kernel z'z, the thesis' baseline (section 7.3). Points and radius are ours. Each entry of
an observation varies alone, so entries that depend on one another, such as those of a rotation,
also make candidates that no motion reaches.
"""

from dataclasses import replace
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Count, NotNegative, part
from hybrid_rl.protocols import Controller, GoalPolicy, Uncertain
from hybrid_rl.types import Params, Spec


@part
class VisitController:
    """`controller`, whose policy aims at a new uncertain state at every decision."""

    controller: Controller
    model: Uncertain
    policy: GoalPolicy
    radius: tuple[NotNegative, ...] = (0.5,)  # [unit of o] one for all entries, or one each
    samples: Count = 100  # candidates

    def init(self, spec: Spec) -> Any:
        """The initial state of the inner controller."""
        return self.controller.init(spec)

    def act(
        self, params: Params, state: Any, obs: Array, key: Array
    ) -> tuple[Array, Any, dict[str, Array]]:
        """Action [m], next state, metrics of the inner controller. The key is consumed."""
        drawing, acting = jax.random.split(key)
        shape = (self.samples, obs.size)
        offsets = jnp.array(self.radius)[None] * jax.random.uniform(drawing, shape, minval=-1)
        near = jax.vmap(self.model.lift, (None, 0))(params.model, obs[None] + offsets)
        spread = jnp.linalg.norm(jax.vmap(self.model.std, (None, 0))(params.model, near), axis=-1)
        goal = near[jnp.argmax(spread)]
        step = partial(self.model.step, params.model)
        policy = self.policy.aim(params.policy, goal, goal, step)
        return self.controller.act(params._replace(policy=policy), state, obs, acting)

    def greedy(self) -> "VisitController":
        """The same around the controller without exploration."""
        return replace(self, controller=self.controller.greedy())
