"""Receding-horizon control by refits: a Gaussian over plans, fitted several times to the best.

    v^k ~ N(mu, sigma^2) clipped to [-1, 1], a share of them from `proposal`        K candidates
    mu <- sum_k w_k v^k,  sigma <- clip(std_w(v^k), floor, spread),  w = softmax(S / lambda)

over the `elites` best candidates, whose S is divided by their standard deviation, so that lambda
is a pure number. S is the predicted return less a price for the ensemble's disagreement, as in
controllers.gradient. The mean acts; the last plan is where the next one begins.

Source: the planner of TD-MPC2 (Hansen et al. 2024), which is MPPI (Williams et al. 2017) with the
elites of the cross-entropy method; there with a critic at the end of a short horizon.
"""

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import adjoint, lifting, sampling
from hybrid_rl.core.batching import prepend
from hybrid_rl.core.members import predict_members
from hybrid_rl.fields import Count, FieldError, Fraction, NotNegative, Positive, part
from hybrid_rl.protocols import Model, Objective, Proposal
from hybrid_rl.types import Params, Path, Return, Spec


class RefitsState(NamedTuple):
    """The planner's state between two decisions."""

    plan: Array  # [T, m]
    carries: Any  # [share K, ...] of the proposal; None without
    u: Array  # [m] the previous action
    memory: Any  # of the objective


@part
class RefitsController:
    """A planner over K candidates, T decisions and several refits."""

    model: Model
    objective: Objective
    proposal: Proposal | None = None  # of the share, such as roll-outs of a policy; None: no share
    horizon: Count = 15  # T [decisions]
    samples: Count = 128  # K
    share: Fraction = 0.25  # of the candidates
    elites: Count = 16
    refits: Count = 4
    spread: Positive = 1.0  # [u] the first standard deviation
    floor: Positive = 0.05  # [u] the least one
    temperature: Positive = 0.5  # lambda [std of the elites' returns]
    disagreement_price: NotNegative = 3.0  # of one running std of the change, in one decision

    def __post_init__(self) -> None:
        if self.elites > self.samples:
            raise FieldError(self, "elites", f"must be at most samples={self.samples}")

    def init(self, spec: Spec) -> RefitsState:
        """A plan of zeros, and the initial carries and memory."""
        plan, carries = jnp.zeros((self.horizon, spec.act)), None
        if (proposal := self.proposal) is not None and self._own:
            quantiles = jnp.arange(self._own) / self._own
            carries = jax.vmap(lambda q: proposal.init(spec, q))(quantiles)
        return RefitsState(plan, carries, plan[0], self.objective.init(spec))

    def act(
        self, params: Params, state: RefitsState, obs: Array, key: Array
    ) -> tuple[Array, RefitsState, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        preparing, rolling, drawing = jax.random.split(key, 3)
        x = lifting.start(self.model, params, obs)
        value, memory = self.objective.prepare(params, state.memory, x, state.u, preparing)
        own = self._proposed(params, state, x, rolling)
        score = jax.vmap(lambda v: self._score(params, value, x, v))

        def refit(fit: tuple[Array, Array], key: Array) -> tuple[tuple[Array, Array], Array]:
            mu, sigma = fit
            e = jax.random.normal(key, (self.samples - len(own), *mu.shape))
            v = jnp.concatenate([own, jnp.clip(mu[None] + sigma[None] * e, -1, 1)])
            S, J = score(v)
            S, best = jax.lax.top_k(S, self.elites)
            w = sampling.weights(S[:, None], self.temperature, normalise=True)[:, 0]
            v = sampling.kept(w[:, None, None], v[best])
            mu = jnp.einsum("k,ktm->tm", w, v)
            variance = jnp.einsum("k,ktm->tm", w, (v - mu[None]) ** 2)
            return (mu, jnp.clip(jnp.sqrt(variance), self.floor, self.spread)), J[best[0]]

        first = state.plan, jnp.full_like(state.plan, self.spread)
        (plan, sigma), J = jax.lax.scan(refit, first, jax.random.split(drawing, self.refits))
        metrics = {"planner/planned_return": J[-1], "planner/spread": sigma[0].mean()}
        begin = sampling.sound(plan, 0.0)
        after = RefitsState(sampling.shift(begin), state.carries, begin[0], memory)
        return plan[0], after, metrics

    def greedy(self) -> "RefitsController":
        """The same controller: the mean acts."""
        return self

    @property
    def _own(self) -> int:
        """The number of candidates from the proposal."""
        return 0 if self.proposal is None else round(self.share * self.samples)

    def _proposed(self, params: Params, state: RefitsState, x: Array, key: Array) -> Array:
        """Plans [share K, T, m] of the proposal from x [n]. The key is consumed."""
        if (proposal := self.proposal) is None or not self._own:
            return jnp.zeros((0, *state.plan.shape))
        noise = jax.random.normal(key, (self._own, *state.plan.shape))
        return sampling.imagine(
            partial(self.model.step, params.model),
            lambda carry, x, *a: proposal(params, carry, lifting.policy_input(x), *a),
            state.carries,
            x,
            state.plan,
            jax.vmap(proposal.shaped)(noise),
        ).path.u

    def _score(self, params: Params, value: Return, x: Array, v: Array) -> tuple[Array, Array]:
        """S [] and J [] of a plan v [T, m] from x [n]."""

        def forward(x: Array, u: Array) -> tuple[Array, tuple[Array, Array]]:
            after, apart, _ = predict_members(self.model, params.model, x, u)
            return after, (after, apart.mean())

        _, (xs, apart) = jax.lax.scan(forward, x, v, unroll=adjoint.scan_unroll(len(v), x))
        J = value(Path(prepend(x, xs), v))
        score = J - self.disagreement_price * apart.sum()
        return jnp.where(jnp.isfinite(score), score, -jnp.inf), J
