"""Receding-horizon control by sampling: plan with the core, execute, shift.

Stochastic hybrid learning (thesis Algorithm 3) with proposals from the policy; MPPI on a
learned model with proposals from noise. `execute` chooses the action from the weighted
candidates: `mean` executes sum_k w_k v_k (the thesis); `sample` draws one of them, which keeps the
policy's exploration in the data; `best` executes the candidate of the greatest return. Where no
candidate has a finite return, the action is NaN, which ends a run in one line. With `model=world`
candidates run through the world's states.

An objective that is a sum over time weighs each decision of a candidate by the return from that
decision on; any other objective weighs all of them by J (Williams et al. 2017).
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import adjoint, lifting, sampling
from hybrid_rl.core.sampling import Candidates, Kept
from hybrid_rl.fields import Count, FieldError, Positive, Signed, part
from hybrid_rl.protocols import Model, Objective, Policy, Proposal
from hybrid_rl.types import Considered, EnvState, Params, Path, Spec

ToGo = Callable[[Path], Array]  # path -> S [T+1], the return from each time on


@part
class SamplingController:
    """A planner over K candidates and T decisions."""

    model: Model
    objective: Objective
    proposal: Proposal
    policy: Policy | None = None  # only for metrics that compare it with the plan
    horizon: Count = 5  # T [decisions]
    samples: Count = 20  # K
    temperature: Positive = 0.1  # lambda [return]; [std of returns] with normalise
    normalise: bool = False
    log_density: bool = False  # the thesis' p(v) in the weight
    execute: Literal["mean", "sample", "best"] = "mean"
    rest: Signed = 0.0  # [u] initial plan, and the last action of a shifted one
    agreement_every: Count = 1  # decisions between comparisons with `policy`

    def __post_init__(self) -> None:
        if self.log_density and not getattr(self.proposal, "density", True):
            words = "needs candidates with a density; choose proposal=policy or proposal=noise"
            raise FieldError(self, "log_density", f"{words}, or false")

    def init(self, spec: Spec) -> Kept:
        """The plan of `rest`, and the initial carries and memory."""
        plan = jnp.full((self.horizon, spec.act), self.rest)
        carries = Candidates(self.proposal, self.samples).begin(spec)
        return Kept(plan, jnp.zeros(spec.act), self.objective.init(spec), carries)

    def act(
        self, params: Params, state: Kept, obs: Array, key: Array
    ) -> tuple[Array, Kept, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        return self.considered(params, state, obs, key)[:3]

    def considered(
        self, params: Params, state: Kept, obs: Array, key: Array
    ) -> tuple[Array, Kept, dict[str, Array], Considered]:
        """What `act` returns, and the candidates."""
        rolling, choosing = jax.random.split(key)
        x = lifting.start(self.model, params, obs)
        to_go, memory, rolling = self._to_go(params, state, x, rolling)
        step = partial(self.model.step, params.model)
        drawn = Candidates(self.proposal, self.samples)
        samples = drawn.imagine(params, step, state.more, x, state.plan, rolling)
        returns = jax.vmap(to_go)(samples.path)
        w = sampling.weights(
            returns[:, :-1],
            self.temperature,
            self.normalise,
            samples.log_prob if self.log_density else None,
        )
        plan = jnp.einsum("kt,ktm->tm", w, sampling.kept(w[..., None], samples.path.u))
        if self.execute == "best":
            S = jnp.where(jnp.isfinite(returns[:, 0]), returns[:, 0], -jnp.inf)
            plan = jnp.where(jnp.isfinite(S.max()), samples.path.u[jnp.argmax(S)], jnp.nan)
        action = plan[0]
        if self.execute == "sample":
            one = samples.path.u[jax.random.categorical(choosing, jnp.log(w[:, 0])), 0]
            action = jnp.where(jnp.isnan(action), action, one)
        metrics = {
            "planner/effective_samples": sampling.effective_samples(w)[0],
            "planner/planned_return": w[:, 0] @ sampling.kept(w, returns[:, :-1])[:, 0],
            **self._agreement(params, x, plan, to_go),
        }
        after = state.later(plan, action, memory, self.rest)
        return action, after, metrics, Considered(samples.path, jnp.argmax(w[:, 0]))

    def _to_go(self, params: Params, state: Kept, x: Any, key: Array) -> tuple[ToGo, Any, Array]:
        """S of paths from x [n], the objective's memory, and a key for other uses."""
        to_go = getattr(self.objective, "reward_to_go", None)
        if to_go is not None:
            return lambda path: to_go(params, path), state.memory, key
        key, preparing = jax.random.split(key)
        value, memory = self.objective.prepare(params, state.memory, x, state.u, preparing)
        return lambda path: jnp.full(len(path.u) + 1, value(path)), memory, key

    def _agreement(self, params: Params, x: Any, plan: Array, to_go: ToGo) -> dict[str, Array]:
        """Metrics of the difference between the weighted mean and the policy's action.

        NaN between multiples of `agreement_every`. None on the world itself, which has no
        derivatives.
        """
        if self.policy is None or isinstance(x, EnvState):
            return {}
        step, policy = partial(self.model.step, params.model), self.policy
        given = step, policy, params, lambda path: to_go(path)[0], x, plan[0], self.horizon
        compare, decisions = partial(adjoint.agreement, *given), params.decisions
        if self.agreement_every == 1 or decisions is None:
            return compare()
        nothing = jax.tree.map(lambda m: jnp.full(m.shape, jnp.nan), jax.eval_shape(compare))
        due = jnp.asarray(decisions) % self.agreement_every == 0
        return jax.lax.cond(due, compare, lambda: nothing)

    def greedy(self) -> "SamplingController":
        """The controller that executes the weighted mean, or the best candidate."""
        return self if self.execute == "best" else replace(self, execute="mean")
