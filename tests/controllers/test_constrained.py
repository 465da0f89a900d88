"""The gradient planner with a constraint, on dynamics that are known."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from toys import Acting, begun

from hybrid_rl.constraints.limit import Limit
from hybrid_rl.controllers.gradient import Candidate, GradientController, Risk
from hybrid_rl.core.rollout import Priced, predict_members
from hybrid_rl.models.ensemble import Ensemble
from hybrid_rl.models.exact import Exact
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.rewards.known import KnownReward
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import rollout
from hybrid_rl.types import EnvState, Params, Spec


@dataclass(frozen=True)
class Sledge:
    """v' = v + 0.2 u; r = v': the faster the better. o = v [1]."""

    spec: Spec = Spec(obs=1, act=1, dt=0.1)

    def reset(self, key: Array) -> EnvState:
        return EnvState((), jnp.zeros(1), jnp.zeros(()))

    def step(self, state: EnvState, action: Array) -> EnvState:
        after = self.dynamics(state.obs, action)
        return state.replace(obs=after, reward=after[0])

    def dynamics(self, x: Array, u: Array) -> Array:
        return x + 0.2 * u

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        return after[0]

    def quantities(self, obs: Array) -> dict[str, Array]:
        return {"speed": obs[0]}


WORLD, FULL = Sledge(), Acting(1.0)
LIMIT = Limit(WORLD, "speed", 1.0, width=0.02, price=100.0)
SMALL: dict[str, Any] = {"horizon": 6, "tail": 0, "samples": 12, "refined": 2, "iterations": 3}
OBJECTIVE = PredictedReturn(KnownReward(WORLD))
PLANNER = GradientController(Exact(WORLD), OBJECTIVE, **SMALL, noise=0.5, quiet=0.0)


def driven(constraint: Any, given: Any = LIMIT, planner: Any = PLANNER) -> EnvState:
    """The states [21] of an episode of 20 decisions, planned with a constraint."""
    episode = Episode(WORLD, 20, constraint=given)
    acts = replace(planner, constraint=constraint)
    return jax.jit(lambda: rollout(episode, acts, Params(), jax.random.key(0), 20))()


def test_the_plan_keeps_the_limit_that_it_breaks_without() -> None:
    """By a price that is higher than the gain, and by a chance at a price that is lower."""
    free = driven(None)
    assert float(free.obs[-1, 0]) > 3.5
    assert float(free.clock.violations[-1]) >= 14
    cheap = replace(LIMIT, price=0.01)
    for kept in (LIMIT, replace(cheap, chance=0.2)):
        states = driven(kept)
        assert float(states.clock.violations[-1]) == 0
        assert float(states.obs[-1, 0]) > 0.75  # near the limit
    assert float(driven(cheap).clock.violations[-1]) >= 14  # a price that is worth paying
    states = driven(LIMIT, planner=replace(PLANNER, priced=True))  # by a reward that has no price
    assert float(states.clock.violations[-1]) >= 14


def test_from_beyond_the_limit_the_plan_returns() -> None:
    """No candidate is safe then: the nearest one acts, against the reward."""
    planner = replace(PLANNER, constraint=replace(LIMIT, price=0.01, chance=0.2))
    act, state = jax.jit(planner.act), planner.init(WORLD.spec)
    x = jnp.array([3.0])
    for key in jax.random.split(jax.random.key(1), 12):
        u, state, metrics = act(Params(), state, x, key)
        x = WORLD.dynamics(x, u)
    assert float(x[0]) < 1
    assert float(metrics["planner/risk"]) <= 0.2


def test_the_order_of_candidates() -> None:
    """By score among the safe, by distance among the others; what is not finite is the last."""
    risk = jnp.array([0.0, 0.3, 0.9, 0.05, 0.0])
    score = jnp.array([1.0, 50.0, 90.0, 2.0, -jnp.inf])
    beyond = jnp.array([0.1, 4.0, 3.0, 9.0, jnp.inf])
    found = Priced(score, score, 0 * score, score[:, None], Risk(risk, beyond))
    by_chance = replace(PLANNER, constraint=replace(LIMIT, chance=0.1))
    assert np.argsort(by_chance._rank(found)).tolist() == [4, 1, 2, 0, 3]
    for none in (PLANNER, replace(PLANNER, constraint=LIMIT)):
        np.testing.assert_array_equal(none._rank(found), score)


def test_violations_in_the_tail_have_their_price_and_no_chance() -> None:
    """A policy that accelerates is beyond 0.9 from the fifth of ten decisions on."""
    limit = replace(LIMIT, most=0.9)
    planner = replace(PLANNER, policy=FULL, horizon=2, tail=8, constraint=limit)
    x, u, key = jnp.zeros(1), jnp.zeros(1), jax.random.key(0)
    value, _ = planner.objective.prepare(Params(), planner.objective.init(WORLD.spec), x, u, key)
    found = planner._scored(Params(), value, x, Candidate(jnp.ones(()), jnp.zeros((2, 1))))
    p = 1 / (1 + np.exp(-(0.2 * np.arange(1, 11) - 0.9) / 0.02))
    assert float(found.value - found.score) == pytest.approx(100 * p.sum(), rel=1e-4)
    assert max(map(float, found.notes)) < 1e-6


def test_the_probability_is_the_mean_over_the_members() -> None:
    """sigmoid((v' - 1) / w) of each member's own prediction, by hand."""
    model = Ensemble(Gaussian(hidden=(8,)), members=3)
    params = Params(model=begun(model, WORLD.spec, 2))
    x, u = jnp.array([0.9]), jnp.array([0.3])
    limit = Limit(WORLD, "speed", 1.0, width=0.3)
    planner = replace(PLANNER, model=model, constraint=limit)
    mean, apart, each = jax.jit(partial(predict_members, model))(params.model, x, u)
    np.testing.assert_allclose(mean, jax.jit(model.step)(params.model, x, u), rtol=1e-6)
    disagreement = jax.jit(model.disagreement)(params.model, x, u)
    np.testing.assert_allclose(apart, disagreement, atol=1e-4)
    one, weights = jax.jit(model.model.step), jax.device_get(params.model["weights"])
    members = [jax.tree.map(lambda w, i=i: w[i], weights) for i in range(3)]
    by_hand = [one({**params.model, "weights": member}, x, u) for member in members]
    assert np.std(by_hand) > 0.01
    want = np.mean([1 / (1 + np.exp(-(float(v[0]) - 1) / 0.3)) for v in by_hand])
    assert float(planner._risk(x, u, each)[1].risk) == pytest.approx(want, rel=1e-4)
    near = replace(planner, constraint=replace(limit, most=0.4))  # two widths below
    kept = replace(planner, margin=2.0)._risk(x, u, each)
    np.testing.assert_allclose(kept[1], near._risk(x, u, each)[1], rtol=1e-5)
