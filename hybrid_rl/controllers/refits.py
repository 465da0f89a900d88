"""Receding-horizon control by refits: a Gaussian over plans, fitted several times to the best.

    v^k ~ N(mu, sigma^2) clipped to [-1, 1], a share of them from `proposal`        K candidates
    mu <- sum_k w_k v^k,  sigma <- clip(std_w(v^k), floor, spread),  w = softmax(S / lambda)

over the `elites` best candidates, whose S is divided by their standard deviation, so that lambda
is a pure number. S is the predicted return less a price for the ensemble's disagreement, as in
core.rollout. The mean acts; the last plan is where the next one begins.

Source: the planner of TD-MPC2 (Hansen et al. 2024), which is MPPI (Williams et al. 2017) with the
elites of the cross-entropy method; there with a critic at the end of a short horizon.
"""

from functools import partial

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import lifting, sampling
from hybrid_rl.core.rollout import priced
from hybrid_rl.core.sampling import Candidates, Kept
from hybrid_rl.fields import Count, Fraction, NotNegative, Positive, part
from hybrid_rl.protocols import Model, Objective, Proposal
from hybrid_rl.types import Params, Spec


@part
class RefitsController:
    """A planner over K candidates, T decisions and several refits."""

    model: Model
    objective: Objective
    proposal: Proposal | None = None  # of the share, such as roll-outs of a policy; None: no share
    horizon: Count = 15  # T [decisions]
    samples: Count = 128  # K
    share: Fraction = 0.25  # of the candidates
    elites: Count = 16  # at most K
    refits: Count = 4
    spread: Positive = 1.0  # [u] the first standard deviation
    floor: Positive = 0.05  # [u] the least one
    temperature: Positive = 0.5  # lambda [std of the elites' returns]
    disagreement_price: NotNegative = 3.0  # of one running std of the change, in one decision

    def init(self, spec: Spec) -> Kept:
        """A plan of zeros, and the initial carries and memory."""
        plan, carries = jnp.zeros((self.horizon, spec.act)), None
        if (own := self._own) is not None:
            carries = own.begin(spec)
        return Kept(plan, plan[0], self.objective.init(spec), carries)

    def act(
        self, params: Params, state: Kept, obs: Array, key: Array
    ) -> tuple[Array, Kept, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        preparing, rolling, drawing = jax.random.split(key, 3)
        x = lifting.start(self.model, params, obs)
        value, memory = self.objective.prepare(params, state.memory, x, state.u, preparing)
        own = jnp.zeros((0, *state.plan.shape))
        if (drawn := self._own) is not None:
            step = partial(self.model.step, params.model)
            own = drawn.imagine(params, step, state.more, x, state.plan, rolling).path.u
        price, follow = self.disagreement_price, lambda x, u: u
        score = jax.vmap(lambda v: priced(self.model, params.model, value, price, follow, x, v))

        def refit(fit: tuple[Array, Array], key: Array) -> tuple[tuple[Array, Array], Array]:
            mu, sigma = fit
            e = jax.random.normal(key, (self.samples - len(own), *mu.shape))
            v = jnp.concatenate([own, jnp.clip(mu[None] + sigma[None] * e, -1, 1)])
            found = score(v)
            S, best = jax.lax.top_k(found.score, self.elites)
            w = sampling.weights(S[:, None], self.temperature, normalise=True)[:, 0]
            v = sampling.kept(w[:, None, None], v[best])
            mu = jnp.einsum("k,ktm->tm", w, v)
            variance = jnp.einsum("k,ktm->tm", w, (v - mu[None]) ** 2)
            return (mu, jnp.clip(jnp.sqrt(variance), self.floor, self.spread)), found.value[best[0]]

        first = state.plan, jnp.full_like(state.plan, self.spread)
        (plan, sigma), J = jax.lax.scan(refit, first, jax.random.split(drawing, self.refits))
        metrics = {"planner/planned_return": J[-1], "planner/spread": sigma[0].mean()}
        return plan[0], state.later(plan, plan[0], memory), metrics

    def greedy(self) -> "RefitsController":
        """The same controller: the mean acts."""
        return self

    @property
    def _own(self) -> Candidates | None:
        """The candidates from the proposal; None: there are none."""
        count = round(self.share * self.samples)
        return Candidates(self.proposal, count) if self.proposal is not None and count else None
