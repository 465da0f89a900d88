"""Receding-horizon control by the adjoint: correct the policy along the gradient of the return.

    v <- clip(v + W_t g_t),   u = clip(pi(x) + v_t)

One iteration from v = 0 with W = Sigma(x), the policy's variance, is deterministic hybrid
learning: u* = Sigma (f_u' rho_{t+1} + r_u) + mu (thesis Algorithm 2 and Theorem 1). Without a
policy, with a warm start and several iterations, it is shooting model-predictive control.
Around an equilibrium policy, with an ergodic objective and W = R^-1 / dt, it is KL-E3 (thesis
Algorithm 6 and eq. 6.10). `apply` chooses the time tau and the duration lambda of the correction:

    first    plan at every decision, tau = now, lambda = one decision
    horizon  plan every T decisions, tau = now, lambda = T
    search   plan every T decisions, tau and lambda of maximum return; lambda = 0 is no correction

Around an unstable equilibrium its `regulator` bounds v so that the sum is not clipped (the bound
that thesis Theorem 3 leaves to R), unless the regulator alone is. T is at least two time constants
of its loop, as the response to a correction may begin in the wrong direction.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import adjoint, decay
from hybrid_rl.core.sampling import Kept
from hybrid_rl.fields import Count, FieldError, Positive, Share, part
from hybrid_rl.protocols import Model, Objective, Policy, StabilizingPolicy
from hybrid_rl.types import Params, Path, Return, Room, Spec

WINDOWS = 8  # values of tau, and of lambda, that a search compares


@part
class AdjointController:
    """A gradient-based planner around a policy, or around zero."""

    model: Model
    objective: Objective
    policy: Policy | None = None  # None: corrections of a zero action
    horizon: Count = 5  # T [decisions]
    iterations: Count = 1
    warm_start: bool = False  # from the last correction, shifted
    gain: Positive | None = None  # W [u^2 / J]; None: the policy's variance
    gain_decay: Share = 1.0  # of W, per decision of the episode
    run_decay: Share = 1.0  # of W, per decision of the run; where they are not counted, W = 0
    normalise: bool = False  # g by its root mean square over the horizon; W is then [u]
    costate_bound: Positive | None = None  # clip of rho; the thesis' author used 1
    apply: Literal["first", "horizon", "search"] = "first"
    lyapunov: StabilizingPolicy | None = None  # whose V is logged; None: no log
    regulator: StabilizingPolicy | None = None  # whose room bounds v; None: no bound

    def __post_init__(self) -> None:
        if self.gain is None and self.policy is None:
            raise FieldError(self, "gain", "needs a policy, whose variance it takes")

    def init(self, spec: Spec) -> Kept:
        """No correction, and the objective's initial memory."""
        room = self._room()
        T = max(self.horizon, math.ceil(2 * room.time)) if room else self.horizon
        v = jnp.zeros((T, spec.act))
        none = jnp.zeros((), jnp.int32)
        return Kept(v, v[0], self.objective.init(spec), none)

    def act(
        self, params: Params, state: Kept, obs: Array, key: Array
    ) -> tuple[Array, Kept, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        prepare_key = jax.random.split(key)[0]  # keeps the random numbers of version 0.1
        x = self.model.lift(params.model, obs)
        value, memory = self.objective.prepare(params, state.memory, x, state.u, prepare_key)
        count = state.more  # decisions of the episode so far
        factor = self.gain_decay**count * decay.of_run(self.run_decay, params.decisions)
        plan = _Plan(self, params, value, x, state.plan.shape[1], factor)
        due = (self.apply == "first") | (count % len(state.plan) == 0)
        held = state.plan if self.warm_start else jnp.where(due, 0, state.plan)
        if self.apply == "first":
            v = plan.improve(held)
        else:
            v = jax.lax.cond(due, lambda v: plan.window(plan.improve(v)), lambda v: v, held)
        u = jnp.clip(plan.mean(x) + v[0], -1, 1)
        metrics = plan.metrics(v)
        if covered := getattr(self.objective, "covered", None):
            metrics |= covered(params, state.memory, x, prepare_key)
        return u, state.later(v, u, memory)._replace(more=count + 1), metrics

    def _room(self) -> Room | None:
        """What corrections may be, of the regulator of an unstable system."""
        return self.regulator.room() if self.regulator is not None else None

    def greedy(self) -> "AdjointController":
        """The same controller: it has no exploration noise."""
        return self


@dataclass(frozen=True)
class _Plan:
    """The planning problem of one decision, at x [n]."""

    of: AdjointController
    params: Params
    value: Return  # J
    x: Array
    act: int  # m
    factor: Array  # [] on W at this decision

    def step(self, x: Array, u: Array) -> Array:
        """The next state [n] by the model."""
        return self.of.model.step(self.params.model, x, u)

    def mean(self, x: Array) -> Array:
        """The uncorrected action [m] at x [n]."""
        if self.of.policy is None:
            return jnp.zeros(self.act)
        return self.of.policy.mean(self.params.policy, x)

    def roll(self, v: Array) -> Path:
        """The path under corrections v [T, m]."""
        return adjoint.roll(self.step, self.mean, self.x, v)

    def improve(self, v: Array) -> Array:
        """Corrections [T, m] after gradient steps from v [T, m]."""
        regulator, room, most = self.of.regulator, self.of._room(), jnp.inf
        if regulator is not None and room is not None:  # none where it alone is clipped: its loop
            u = regulator.mean(self.params.policy, self.x)  # is not linear
            most = jnp.where(jnp.all(jnp.abs(u) < 1), room.most, jnp.inf)

        def iterate(v: Array, _: None) -> tuple[Array, None]:
            path, bound = self.roll(v), self.of.costate_bound
            g = adjoint.adjoint(self.step, self.mean, self.value, path, bound).gradient
            if self.of.normalise:
                g = g / (jnp.sqrt(jnp.mean(g**2)) + 1e-6)
            u = path.u + self.factor * self._gain(path.x[:-1]) * g
            return jnp.clip(jnp.clip(u, -1, 1) - (path.u - v), -most, most), None

        return jax.lax.scan(iterate, v, None, length=self.of.iterations)[0]

    def _gain(self, x: Array) -> Array | float:
        """The gain W at x [T, n]."""
        if self.of.gain is not None:
            return self.of.gain
        assert self.of.policy is not None  # as __post_init__ has checked
        return jax.vmap(self.of.policy.variance, (None, 0))(self.params.policy, x)

    def window(self, v: Array) -> Array:
        """Corrections v [T, m]; with `search` only those in the window of maximum return."""
        if self.of.apply != "search":
            return v
        T = len(v)
        marks = sorted({round(T * i / WINDOWS) for i in range(WINDOWS + 1)})
        begin, end = jnp.array([(0, 0), *((a, b) for a in marks for b in marks if a < b)]).T
        t = jnp.arange(T)[None]
        inside = (begin[:, None] <= t) & (t < end[:, None])
        parts = jnp.where(inside[:, :, None], v[None], 0)
        returns = jax.vmap(lambda v: self.value(self.roll(v)))(parts)
        return parts[jnp.argmax(returns)]

    def metrics(self, v: Array) -> dict[str, Array]:
        """Metrics of the plan with corrections v [T, m]."""
        mean, path, nominal = self.mean(self.x), self.roll(v), self.roll(0 * v)
        action = mean + v[0]
        around = adjoint.adjoint(self.step, self.mean, self.value, nominal)
        insertion = adjoint.mode_insertion_gradient(self.step, self.value, around, action)
        metrics = {
            "planner/mode_insertion_gradient": insertion,
            "planner/planned_return": self.value(path),
        }
        if self.of.policy is not None:
            own, correction = jnp.linalg.norm(mean), jnp.linalg.norm(action - mean)
            metrics["planner/policy_share"] = own / (own + correction + 1e-6)
            metrics["planner/correction"] = correction
            if self.of.gain is None:
                variance = self.of.policy.variance(self.params.policy, self.x)
                metrics |= adjoint.per_variance(insertion, variance)
        if self.of.lyapunov is not None:
            metrics |= self.stability(self.of.lyapunov.lyapunov, path)
        return metrics

    def stability(self, V: Callable[[Array], Array], path: Path) -> dict[str, Array]:
        """V at the first state of a path, and how much it changes in a decision.

            rate  = V(f(x, pi(x))) - V(x)                                 under the policy
            bound = max_t V(f(x_t, u_t)) - V(f(x_t, pi(x_t)))             thesis eq. (6.15), beta

        Where f is affine in u, V(f(x, u)) - V(f(x, pi)) is V_x h (u - pi) dt to first order, as
        printed. Theorem 3, V(x^lambda) - V(x) <= lambda beta, is first-order in lambda.
        """

        def apart(x: Array, u: Array) -> Array:
            return V(self.step(x, u)) - V(self.step(x, self.mean(x)))

        x, now = path.x[0], V(path.x[0])
        return {
            "planner/lyapunov": now,
            "planner/lyapunov_rate": V(self.step(x, self.mean(x))) - now,
            "planner/lyapunov_bound": jnp.max(jax.vmap(apart)(path.x[:-1], path.u)),
        }
