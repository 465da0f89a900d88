"""Receding-horizon control by sampling: plan with the core, execute, shift.

Stochastic hybrid learning (thesis Algorithm 3) with proposals from the policy; MPPI on a
learned model with proposals from noise. `execute` chooses the action from the weighted
candidates: `mean` executes sum_k w_k v_k (the thesis); `sample` draws one of them, which keeps the
policy's exploration in the data.
"""

from dataclasses import dataclass, replace
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import adjoint, sampling
from hybrid_rl.protocols import Model, Policy, Proposal, Staged
from hybrid_rl.types import Params, Path, Spec

EXECUTE = ("mean", "sample")


@dataclass(frozen=True)
class SamplingController:
    """A planner over K candidates and T decisions.

    Raises:
        ValueError: for a horizon, a number of samples or a temperature that is not positive,
            an unknown `execute`, or `log_density` of candidates from several distributions.
    """

    model: Model
    objective: Staged
    proposal: Proposal
    policy: Policy | None = None  # only for metrics that compare it with the plan
    horizon: int = 5  # T [decisions]
    samples: int = 20  # K
    temperature: float = 0.1  # lambda [return]; [std of returns] with normalise
    normalise: bool = False
    log_density: bool = False  # the thesis' p(v) in the weight
    execute: str = "mean"
    rest: float = 0.0  # [u] initial plan, and the last action of a shifted one

    def __post_init__(self) -> None:
        """Check the fields."""
        for name in ("horizon", "samples"):
            value = getattr(self, name)
            if not isinstance(value, int) or value < 1:
                raise ValueError(f"planner.{name}={value}: must be a whole number, 1 or more")
        if not self.temperature > 0:
            raise ValueError(f"planner.temperature={self.temperature}: must be above 0")
        if self.execute not in EXECUTE:
            raise ValueError(f"planner.execute={self.execute}: choose {' or '.join(EXECUTE)}")
        if self.log_density and getattr(self.proposal, "mixed", False):
            raise ValueError(
                "planner.log_density=True: needs candidates of one distribution; "
                "choose proposal=policy or proposal=noise, or false"
            )

    def init(self, spec: Spec) -> tuple[Array, Any]:
        """The plan [T, m] of `rest`, and the proposal's initial carries [K, ...]."""
        quantiles = jnp.arange(self.samples) / self.samples
        carries = jax.vmap(lambda q: self.proposal.init(spec, q))(quantiles)
        return jnp.full((self.horizon, spec.act), self.rest), carries

    def act(
        self, params: Params, state: tuple[Array, Any], obs: Array, key: Array
    ) -> tuple[Array, tuple[Array, Any], dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        plan, carries = state
        rolling, choosing = jax.random.split(key)
        x = self.model.lift(params.model, obs)
        samples = sampling.imagine(
            lambda x, u: self.model.step(params.model, x, u),
            lambda *a: self.proposal(params, *a),
            carries,
            x,
            plan,
            jax.random.normal(rolling, (self.samples, *plan.shape)),
        )
        returns = jax.vmap(lambda path: self.objective.reward_to_go(params, path))(samples.path)
        w = sampling.weights(
            returns[:, :-1],
            self.temperature,
            self.normalise,
            samples.log_prob if self.log_density else None,
        )
        plan = jnp.einsum("kt,ktm->tm", w, samples.path.u)
        action = plan[0]
        if self.execute == "sample":
            action = samples.path.u[jax.random.categorical(choosing, jnp.log(w[:, 0])), 0]
        metrics = {
            "planner/effective_samples": sampling.effective_samples(w)[0],
            "planner/planned_return": w[:, 0] @ returns[:, 0],
            "planner/planned_reward": w[:, 0] @ self._rewards(params, samples.path),
            **self._agreement(params, x, plan),
        }
        return action, (sampling.shift(plan, self.rest), carries), metrics

    def _rewards(self, params: Params, paths: Path) -> Array:
        """Rewards [K] of the first decisions of paths x [K, T+1, n], u [K, T, m]."""
        first = Path(paths.x[:, :2], paths.u[:, :1])
        return jax.vmap(lambda path: self.objective.rewards(params, path)[0])(first)

    def _agreement(self, params: Params, x: Array, plan: Array) -> dict[str, Array]:
        """Metrics of the difference between the weighted mean and the policy's action.

        The share |mu| / (|mu| + |u - mu|) is 1 if the plan follows the policy, else near 0.
        """
        if self.policy is None:
            return {}
        policy = self.policy

        def step(x: Array, u: Array) -> Array:
            return self.model.step(params.model, x, u)

        def mean(x: Array) -> Array:
            return policy.mean(params.policy, x)

        def value(path: Path) -> Array:
            return self.objective.reward_to_go(params, path)[0]

        insertion = adjoint.insertion_ahead(step, mean, value, x, plan[0], self.horizon)
        own = jnp.linalg.norm(mean(x))
        correction = jnp.linalg.norm(plan[0] - mean(x))
        return {
            "planner/mode_insertion_gradient": insertion,
            **adjoint.per_variance(insertion, policy.variance(params.policy, x)),
            "planner/policy_share": own / (own + correction + 1e-6),
        }

    def greedy(self) -> "SamplingController":
        """The controller that executes the weighted mean."""
        return replace(self, execute="mean")
