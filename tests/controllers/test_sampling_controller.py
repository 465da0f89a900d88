"""The sampling controller with known candidates."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.controllers.sampling import SamplingController
from hybrid_rl.core import sampling
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.proposals.mixture import MixtureProposal
from hybrid_rl.rewards.network import RewardNetwork
from hybrid_rl.types import Params, Path, Spec

SPEC = Spec(obs=2, act=1, dt=0.1)
X = jnp.array([0.3, -0.4])
T, K = 3, 4


@dataclass(frozen=True)
class Cart:
    """A mass on a line: x' = [p + 0.1 v, v + 0.1 u]."""

    def lift(self, params: Any, obs: Array) -> Array:
        """The observation."""
        return obs

    def step(self, params: Any, x: Array, u: Array) -> Array:
        """One decision."""
        return jnp.array([x[0] + 0.1 * x[1], x[1] + 0.1 * u[0]])


@dataclass(frozen=True)
class Grid:
    """Candidate k has u = k / K at all times."""

    def init(self, spec: Spec, quantile: Array) -> Array:
        """The action."""
        return quantile

    def shaped(self, noise: Array) -> Array:
        """The noise itself."""
        return noise

    def __call__(self, params: Params, carry: Array, x: Array, plan: Array, noise: Array) -> tuple:
        """The constant action."""
        return jnp.full(1, carry), jnp.zeros(()), carry


@dataclass(frozen=True)
class Closing:
    """A policy of zero action, and a critic of constant value 250."""

    def mean(self, params: Any, x: Array) -> Array:
        """No action."""
        return jnp.zeros(1)

    def variance(self, params: Any, x: Array) -> Array:
        """Of the action."""
        return jnp.full(1, 0.25)

    def value(self, params: Any, x: Array, u: Array) -> Array:
        """A constant."""
        return jnp.full((), 250.0)


@pytest.mark.parametrize("ends", [False, True])
def test_planned_reward_is_that_of_the_first_decision(ends: bool) -> None:
    """The reward network's output at x and u, whether or not episodes end."""
    reward = RewardNetwork(hidden=(8,), ends=ends)
    objective = PredictedReturn(reward, discount=0.9, critic=Closing(), policy=Closing())
    params = Params(reward=reward.init(jax.random.key(0), SPEC))
    paths = Path(np.zeros((K, T + 1, 2), np.float32), np.zeros((K, T, 1), np.float32))
    for k in range(K):
        paths.x[k, 0], paths.u[k] = X, k / K
        for t in range(T):
            paths.x[k, t + 1] = Cart().step((), paths.x[k, t], paths.u[k, t])
    to_go = jax.jit(jax.vmap(lambda path: objective.reward_to_go(params, path)))(paths)
    w = np.asarray(sampling.weights(to_go[:, :-1], 0.1))[:, 0]
    first = jax.jit(jax.vmap(lambda u: reward.outcome(params, X, u, X)[0]))(paths.u[:, 0])
    controller = SamplingController(Cart(), objective, Grid(), horizon=T, samples=K)
    given = params, controller.init(SPEC), X, jax.random.key(1)
    both = jax.jit(lambda *of: (controller.act(*of)[2], controller.considered(*of)[3]))
    metrics, found = both(*given)  # the candidates, and the one that weighs most
    assert float(metrics["planner/planned_reward"]) == pytest.approx(w @ first, rel=1e-4)
    np.testing.assert_allclose(found.paths.x, paths.x, atol=1e-5)
    assert int(found.chosen) == np.argmax(w)


def test_agreement_is_measured_now_and_then() -> None:
    """At multiples of `agreement_every` decisions, and in evaluations; the plan is the same."""
    reward = RewardNetwork(hidden=(8,))
    params = Params(reward=reward.init(jax.random.key(0), SPEC))

    def act(every: int, decisions: int | None) -> tuple[float, float]:
        parts = Cart(), PredictedReturn(reward), Grid(), Closing()
        controller = SamplingController(*parts, horizon=T, samples=K, agreement_every=every)
        count = None if decisions is None else jnp.int32(decisions)
        known = params._replace(decisions=count)
        u, _, metrics = controller.act(known, controller.init(SPEC), X, jax.random.key(1))
        return float(u[0]), float(metrics["planner/insertion_per_variance"])

    always = act(1, 20)
    assert abs(always[1]) > 1e-4
    assert act(10, 20) == pytest.approx(always, rel=1e-5)
    assert act(10, None) == pytest.approx(always, rel=1e-5)
    assert act(10, 21) == pytest.approx((always[0], np.nan), rel=1e-5, nan_ok=True)


def test_candidates_without_a_density_have_no_density_in_the_weight() -> None:
    """Those of two distributions cannot be compared."""
    mixture = MixtureProposal(Grid(), Grid())
    objective = PredictedReturn(RewardNetwork())
    SamplingController(Cart(), objective, mixture)
    with pytest.raises(ValueError, match="log_density=true: needs candidates with a density"):
        SamplingController(Cart(), objective, mixture, log_density=True)


def test_the_best_candidate_acts() -> None:
    """Exactly one of the candidates, also in evaluations; the mean lies between them."""
    reward = RewardNetwork(hidden=(8,))
    params = Params(reward=reward.init(jax.random.key(0), SPEC))
    objective = PredictedReturn(reward)

    def act(execute: str) -> tuple[float, Any]:
        controller: Any = SamplingController(
            Cart(), objective, Grid(), horizon=T, samples=K, temperature=10.0, execute=execute
        ).greedy()
        u, after, _ = controller.act(params, controller.init(SPEC), X, jax.random.key(1))
        return float(u[0]), after.plan

    best, plan = act("best")
    returns = []
    for k in range(K):
        x = [X]
        for _ in range(T):
            x.append(Cart().step((), x[-1], jnp.full(1, k / K)))
        path = Path(jnp.stack(x), jnp.full((T, 1), k / K))
        returns.append(float(objective.reward_to_go(params, path)[0]))
    assert best == pytest.approx(np.argmax(returns) / K)
    np.testing.assert_allclose(plan[:-1, 0], best, rtol=1e-6)
    assert abs(act("mean")[0] - best) > 0.1
