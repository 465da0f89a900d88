"""Receding-horizon control by the adjoint: correct the policy along the gradient of the return.

    v <- clip(v + W_t g_t),   u = clip(pi(x_0) + v_0 + e),   e ~ N(0, s^2),  s = decay^decisions

One iteration from v = 0 with W = Sigma(x), the policy's variance, is deterministic hybrid
learning: u* = Sigma (f_u' rho_{t+1} + r_u) + mu (thesis Algorithm 2 and Theorem 1). Without a
policy, with a warm start and several iterations, it is shooting model-predictive control.
"""

from dataclasses import dataclass, replace
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import adjoint, sampling
from hybrid_rl.types import Model, Objective, Params, Path, Policy, Spec


@dataclass(frozen=True)
class AdjointController:
    """A planner by gradients, around a policy or around rest.

    Raises:
        ValueError: for counts, gains or rates out of range.
    """

    model: Model
    objective: Objective
    policy: Policy | None = None  # None: corrections around no action at all
    horizon: int = 5  # T [decisions]
    iterations: int = 1
    warm_start: bool = False  # from the last correction, shifted
    gain: float | None = None  # W [u^2 / J]; None: the policy's variance
    normalise: bool = False  # g by its root mean square over the horizon; W is then [u]
    costate_bound: float | None = None  # the author's clip of rho, 1
    noise_decay: float | None = 0.999  # of the executed noise, per decision of the run; None: none

    def __post_init__(self) -> None:
        """Check the fields."""
        for name in ("horizon", "iterations"):
            value = getattr(self, name)
            if not isinstance(value, int) or value < 1:
                raise ValueError(f"adjoint planner: {name}={value}: must be a whole number >= 1")
        if self.gain is None and self.policy is None:
            raise ValueError("adjoint planner: gain=null needs a policy, whose variance it takes")
        if self.gain is not None and not self.gain > 0:
            raise ValueError(f"adjoint planner: gain={self.gain}: must be above 0")
        if self.noise_decay is not None and not 0 < self.noise_decay <= 1:
            raise ValueError(f"adjoint planner: noise_decay={self.noise_decay}: must lie in (0, 1]")

    def init(self, spec: Spec) -> Array:
        """No correction [T, m]."""
        return jnp.zeros((self.horizon, spec.act))

    def act(
        self, params: Params, state: Array, obs: Array, key: Array
    ) -> tuple[Array, Array, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        x = self.model.lift(params.model, obs)
        v = sampling.shift(state) if self.warm_start else jnp.zeros_like(state)

        def step(x: Array, u: Array) -> Array:
            return self.model.step(params.model, x, u)

        def default(x: Array) -> Array:
            if self.policy is None:
                return jnp.zeros(v.shape[1])
            return self.policy.mean(params.policy, x)

        def value(path: Path) -> Array:
            return self.objective.reward_to_go(params, path)[0]

        def better(v: Array, _: None) -> tuple[Array, None]:
            path = adjoint.roll(step, default, x, v)
            g = adjoint.adjoint(step, default, value, path, self.costate_bound).gradient
            if self.normalise:
                g = g / (jnp.sqrt(jnp.mean(g**2)) + 1e-6)
            u = path.u + self._gain(params, path.x[:-1]) * g
            return jnp.clip(u, -1, 1) - (path.u - v), None

        v = jax.lax.scan(better, v, None, length=self.iterations)[0]
        mean = default(x)
        action = mean + v[0]
        nominal = adjoint.roll(step, default, x, jnp.zeros_like(v))
        around = adjoint.adjoint(step, default, value, nominal)
        metrics = {
            "planner/mode_insertion_gradient": adjoint.mode_insertion_gradient(
                step, value, around, action
            ),
            "planner/planned_return": value(adjoint.roll(step, default, x, v)),
        }
        if self.policy is not None:
            own, correction = jnp.linalg.norm(mean), jnp.linalg.norm(action - mean)
            metrics["planner/policy_share"] = own / (own + correction + 1e-6)
        if self.noise_decay is not None:
            decisions: Any = params.decisions
            spread = self.noise_decay**decisions
            action = action + spread * jax.random.normal(key, action.shape)
        return jnp.clip(action, -1, 1), v, metrics

    def _gain(self, params: Params, x: Array) -> Array | float:
        """W at x [T, n]."""
        if self.gain is not None:
            return self.gain
        policy: Any = self.policy  # of which __post_init__ made sure
        return jax.vmap(policy.variance, (None, 0))(params.policy, x)

    def greedy(self) -> "AdjointController":
        """Without noise."""
        return replace(self, noise_decay=None)
