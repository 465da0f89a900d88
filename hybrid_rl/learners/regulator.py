"""Solve the linear-quadratic regulator of a learned model, and its feed-forward.

    f(x, u) to first order at the goal: A = f_x, B = f_u;   P_0 = 0, T Riccati steps -> F
    hold = argmin |Q^1/2 (goal - f(goal, hold))|

The horizon is finite: a lift that does not close under the dynamics has modes that no action
reaches, and with an infinite horizon their cost has no bound. The model can be any with
derivatives; for a Koopman operator A and B are K itself. A solution that is not finite is rejected
and the last one kept. Source: thesis section 7.1.1, Algorithm 7, line 3.
"""

from functools import partial
from typing import Annotated, Any, ClassVar

import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.core import riccati
from hybrid_rl.core.lifting import lifted_spec
from hybrid_rl.core.riccati import linearise
from hybrid_rl.core.solving import solve
from hybrid_rl.fields import FILLED, Count, NotNegative, Positive, part
from hybrid_rl.protocols import Balanced, GoalPolicy, Model
from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class SolutionState:
    """The policy's parameters, and how many solutions were rejected."""

    policy: dict[str, Array]
    rejected: Array  # []


@part
class RegulatorLearner:
    """A linear policy that regulates a model to the equilibrium of `world`."""

    model: Model
    policy: GoalPolicy
    world: Balanced
    state_weights: Annotated[tuple[NotNegative, ...], FILLED] = (1.0,)  # Q: one, or the first
    action_weights: tuple[Positive, ...] = (1.0,)  # diagonal of R: one for all actions, or one each
    horizon: Count = 128  # T [decisions]
    feedforward: bool = True  # false: hold = 0
    every: Count = 1  # decisions between two solutions

    data: ClassVar[str] = "latest"
    owns: ClassVar[tuple[str, ...]] = ("policy",)

    def init(self, key: Array, spec: Spec) -> SolutionState:
        """No gain yet. The key is consumed."""
        lifted = lifted_spec(self.model, spec)
        self._weights(lifted.n, spec.act)
        return SolutionState(self.policy.init(key, lifted), jnp.zeros(()))

    def _weights(self, n: int, m: int) -> tuple[Array, Array]:
        """Q [n, n] and R [m, m]."""
        q, r = self.state_weights, self.action_weights
        q = q * n if len(q) == 1 else (*q, *[0.0] * (n - len(q)))
        R = riccati.as_weights("policy_learner.action_weights", r, m)
        return jnp.diag(jnp.array(q)), jnp.asarray(R, jnp.float32)

    def params(self, state: SolutionState) -> dict[str, Any]:
        """The policy."""
        return {"policy": state.policy}

    def update(
        self, state: SolutionState, params: Params, batch: Batch, key: Array
    ) -> tuple[SolutionState, dict[str, Array]]:
        """The solution for the model as it is; neither the decisions nor the key are used."""
        solved = self.solve(params.model, state.policy)
        finite = jnp.all(jnp.array([jnp.all(jnp.isfinite(leaf)) for leaf in solved.values()]))
        policy = {name: jnp.where(finite, solved[name], old) for name, old in state.policy.items()}
        rejected = state.rejected + ~finite
        metrics = {
            "policy/gain": jnp.linalg.norm(policy["gain"]),
            "policy/rejected_solutions": rejected,
        }
        return SolutionState(policy, rejected), metrics

    def solve(self, model: Any, policy: dict[str, Array]) -> dict[str, Array]:
        """The policy's parameters for the model's; those before are where u is linearised."""
        step = partial(self.model.step, model)
        obs, _ = self.world.equilibrium()
        goal = self.model.lift(model, obs.astype(policy["goal"].dtype))
        A, B = linearise(step, goal, policy["hold"])
        Q, R = self._weights(*B.shape)
        P = riccati.finite_horizon(A, B, Q, R, self.horizon)
        solved = {**policy, "gain": riccati.gain(A, B, P, R)}
        if not self.feedforward:
            return {**solved, "goal": goal}
        square = B.T @ Q @ B
        ridge = 1e-6 * jnp.trace(square) + 1e-12
        solved["inverse"] = solve(square + ridge * jnp.eye(len(R)), B.T @ Q)
        return self.policy.aim(solved, goal, goal, step)
