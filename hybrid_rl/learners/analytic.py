"""Learn a policy by the gradient of a known return through a known model.

    max_theta E[ J(path) ] / T,   x_{t+1} = f(x_t, pi(x_t; theta)),   x_0 from the environment

The gradient goes through the dynamics, from all T decisions of each of `starts` fresh paths, and is
scaled to a norm of at most `clip`. The transitions of the run are not used. Source: thesis
appendix C trains its backflip expert by a policy gradient and gives the rate of Adam; the rest is
our choice.
"""

from functools import partial
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.core import adjoint
from hybrid_rl.core.lifting import lifted_spec
from hybrid_rl.fields import Count, Positive, part
from hybrid_rl.protocols import Env, LearnedPolicy, Model, Objective
from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class AnalyticState:
    """The policy's parameters and their optimiser."""

    policy: Any
    optimiser: Any


@part
class AnalyticGradient:
    """Gradient ascent on the return of imagined paths, one Adam step per decision of the run."""

    policy: LearnedPolicy
    model: Model
    objective: Objective
    world: Env  # its first states begin the paths
    horizon: Count = 100  # T [decisions]
    starts: Count = 64  # paths of a step
    learning_rate: Positive = 3e-3
    clip: Positive = 1.0  # largest norm of the gradient

    data: ClassVar[str] = "latest"
    owns: ClassVar[tuple[str, ...]] = ("policy",)
    every: ClassVar[int] = 1

    @property
    def _optimiser(self) -> optax.GradientTransformation:
        return optax.chain(optax.clip_by_global_norm(self.clip), optax.adam(self.learning_rate))

    def init(self, key: Array, spec: Spec) -> AnalyticState:
        """Initial parameters and optimiser. The key is consumed."""
        policy = self.policy.init(key, lifted_spec(self.model, spec))
        return AnalyticState(policy, self._optimiser.init(policy))

    def params(self, state: AnalyticState) -> dict[str, Any]:
        """The policy."""
        return {"policy": state.policy}

    def update(
        self, state: AnalyticState, params: Params, batch: Batch, key: Array
    ) -> tuple[AnalyticState, dict[str, Array]]:
        """One step; the loss is minus the mean return per decision. The key is consumed."""
        starting, drawing = jax.random.split(key)
        obs = jax.vmap(self.world.reset)(jax.random.split(starting, self.starts)).obs
        keys = jax.random.split(drawing, self.starts)

        def loss(policy: Any) -> Array:
            known = params._replace(policy=policy)
            return -jax.vmap(lambda obs, key: self._value(known, obs, key))(obs, keys).mean()

        value, grads = jax.value_and_grad(loss)(state.policy)
        change, optimiser = self._optimiser.update(grads, state.optimiser)
        norm = jnp.sqrt(sum(jnp.sum(leaf**2) for leaf in jax.tree.leaves(grads)))
        metrics = {"analytic/policy_loss": value, "analytic/gradient_norm": norm}
        return AnalyticState(optax.apply_updates(state.policy, change), optimiser), metrics

    def _value(self, params: Params, obs: Array, key: Array) -> Array:
        """J / T [] of the policy's path from obs [o]. The key is consumed."""
        m = self.world.spec.act
        x, memory = self.model.lift(params.model, obs), self.objective.init(self.world.spec)
        value, _ = self.objective.prepare(params, memory, x, jnp.zeros(m), key)
        step = partial(self.model.step, params.model)
        mean = partial(self.policy.mean, params.policy)
        path = adjoint.roll(step, mean, x, jnp.zeros((self.horizon, m)))
        return value(path) / self.horizon
