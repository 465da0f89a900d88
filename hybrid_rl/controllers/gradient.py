"""Receding-horizon control by gradient ascent through the model, from several starts.

    v_k ~ proposal,  k = 1..K                          roll-outs in the model
    v <- clip(v + step g / rms(g)),  g = dS/dv         of the best of them, and of the last plan
    S = J - price sum_t d_t                            the best of these acts

d_t is the mean over the entries of the state of the ensemble's disagreement, in running standard
deviations of the change. Without it, gradients lead to where the model is wrong. With roll-outs of
the policy at several strengths as starts, the policy remembers what the model cannot find by
itself, and the gradient corrects it for the goal at hand.

Sources: gradient steps from roll-outs of a policy as in Dream-MPC (2026); several strengths, the
step by its root mean square and the price are our choice.
"""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import adjoint, agreement, lifting, sampling
from hybrid_rl.fields import Count, Natural, NotNegative, Positive, part
from hybrid_rl.protocols import Model, Objective, Policy, Proposal
from hybrid_rl.types import Params, Path, Return, Spec


class GradientState(NamedTuple):
    """The planner's state between two decisions."""

    plan: Array  # [T, m]
    carries: Any  # [K, ...] of the proposal
    u: Array  # [m] the previous action
    memory: Any  # of the objective


class _Scored(NamedTuple):
    """Open-loop candidates."""

    u: Array  # [K, T, m]
    score: Array  # [K] S
    disagreement: Array  # [K] sum over time


@part
class GradientController:
    """A planner over K starts and T decisions.

    Raises:
        ValueError: for counts, a step or a price out of range.
    """

    model: Model
    objective: Objective
    proposal: Proposal
    policy: Policy | None = None  # only for metrics that compare it with the plan
    horizon: Count = 20  # T [decisions]
    samples: Count = 32  # K
    refined: Count = 5  # of the K, which gradients improve
    iterations: Natural = 5
    step: Positive = 0.05  # [u] root mean square of an iteration's change
    disagreement_price: NotNegative = 3.0  # of one running std of the change, in one decision

    def init(self, spec: Spec) -> GradientState:
        """A plan of zeros, and the initial carries and memory."""
        carries = jax.vmap(lambda q: self.proposal.init(spec, q))(
            jnp.arange(self.samples) / self.samples
        )
        plan = jnp.zeros((self.horizon, spec.act))
        return GradientState(plan, carries, plan[0], self.objective.init(spec))

    def act(
        self, params: Params, state: GradientState, obs: Array, key: Array
    ) -> tuple[Array, GradientState, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        preparing, rolling = jax.random.split(key)
        x = lifting.start(self.model, params, obs)
        value, memory = self.objective.prepare(params, state.memory, x, state.u, preparing)
        starts = self._starts(params, state, x, rolling)
        score = jax.vmap(lambda u: self._scored(params, value, x, u))
        first = score(starts)
        best = first.u[jax.lax.top_k(first.score, min(self.refined, self.samples))[1]]
        u = self._improved(params, value, x, jnp.concatenate([state.plan[None], best]))
        found = score(u)
        plan, scored = jax.tree.map(lambda leaf: leaf[jnp.argmax(found.score)], (u, found))
        metrics = {
            "planner/planned_return": scored.score + self.disagreement_price * scored.disagreement,
            "planner/disagreement": scored.disagreement / self.horizon,
            "planner/gain": found.score.max() - first.score.max(),
            **self._agreement(params, value, x, plan[0]),
        }
        after = GradientState(sampling.shift(plan), state.carries, plan[0], memory)
        return plan[0], after, metrics

    def greedy(self) -> "GradientController":
        """The same controller: the best candidate acts."""
        return self

    def _starts(self, params: Params, state: GradientState, x: Array, key: Array) -> Array:
        """Candidates [K, T, m] of the proposal. The key is consumed."""
        noise = jax.random.normal(key, (self.samples, *state.plan.shape))
        samples = sampling.imagine(
            lambda x, u: self.model.step(params.model, x, u),
            lambda carry, x, *a: self.proposal(params, carry, lifting.seen(x), *a),
            state.carries,
            x,
            state.plan,
            jax.vmap(self.proposal.shaped)(noise),
        )
        return samples.path.u

    def _scored(self, params: Params, value: Return, x: Array, u: Array) -> _Scored:
        """The candidate u [T, m] from x [n]."""
        model: Any = self.model
        both = getattr(model, "step_and_disagreement", None)

        def forward(x: Array, u: Array) -> tuple[Array, tuple[Array, Array]]:
            if both is None:
                after, apart = model.step(params.model, x, u), jnp.zeros(())
            else:
                after, apart = both(params.model, x, u)
            return after, (after, jnp.mean(apart))

        _, (xs, apart) = jax.lax.scan(forward, x, u, unroll=adjoint.scan_unroll(len(u)))
        J = value(Path(jnp.concatenate([x[None], xs]), u))
        score = J - self.disagreement_price * apart.sum()
        return _Scored(u, jnp.where(jnp.isfinite(score), score, -jnp.inf), apart.sum())

    def _improved(self, params: Params, value: Return, x: Array, u: Array) -> Array:
        """Candidates u [C, T, m] after the gradient steps."""

        def iterate(u: Array, _: None) -> tuple[Array, None]:
            g = jax.vmap(jax.grad(lambda u: self._scored(params, value, x, u).score))(u)
            g = jnp.nan_to_num(g, posinf=0.0, neginf=0.0)  # of a path that leaves all bounds
            size = jnp.sqrt(jnp.mean(g**2, (1, 2), keepdims=True))
            return jnp.clip(u + self.step * g / (size + 1e-6), -1, 1), None

        return jax.lax.scan(iterate, u, None, length=self.iterations)[0]

    def _agreement(self, params: Params, value: Return, x: Array, u: Array) -> dict[str, Array]:
        """Metrics of the action u [m] against the policy's."""
        if self.policy is None:
            return {}

        def step(x: Array, u: Array) -> Array:
            return self.model.step(params.model, x, u)

        return agreement.metrics(step, self.policy, params, value, x, u, self.horizon)
