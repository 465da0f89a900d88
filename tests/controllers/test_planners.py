"""Every planner on a mass on a line: the best plan, prices, and what is not finite."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import SPEC, Breaking, Cart, Doubted, speed

from hybrid_rl.controllers.adjoint import AdjointController
from hybrid_rl.controllers.gradient import GradientController
from hybrid_rl.controllers.refits import RefitsController
from hybrid_rl.controllers.sampling import SamplingController
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.models.exact import Exact
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.proposals.noise import NoiseProposal
from hybrid_rl.rewards.known import KnownReward
from hybrid_rl.types import Params

T, CART, COSTLY = 5, Cart(), speed(0.5)


def planner(name: str, model: Any = CART, objective: Any = COSTLY, **fields: Any) -> Any:
    """A planner over T decisions; the fields are those of its kind."""
    fields = {"horizon": T, **fields}
    if name == "shooting":
        return AdjointController(model, objective, **{"gain": 0.1, **fields})
    if name == "gradient":
        small = {"tail": 0, "samples": 8, "refined": 2, "noise": 0.2}
        return GradientController(model, objective, **small | fields)
    if name == "refits":
        return RefitsController(model, objective, **fields)
    return SamplingController(model, objective, NoiseProposal(), **fields)


def act(planner: Any, obs: Any = (0.0, 0.0), state: Any = None, key: int = 0) -> tuple:
    """One decision."""
    state = planner.init(SPEC) if state is None else state
    return jax.jit(planner.act)(Params(), state, jnp.asarray(obs), jax.random.key(key))


@pytest.mark.parametrize(
    ("name", "fields", "error"),
    [
        ("shooting", {"iterations": 200}, 1e-5),
        ("gradient", {"iterations": 60, "step": 0.01, "disagreement_price": 0}, 0.03),
        ("refits", {"refits": 12, "disagreement_price": 0}, 0.06),
    ],
)
def test_a_planner_reaches_the_best_plan(name: str, fields: dict, error: float) -> None:
    """J of speeds less 0.5 u^2 has its greatest value at u = 0.1 n, n decisions before the end."""
    u, state, metrics = act(planner(name, **fields))
    np.testing.assert_allclose(u, 0.5, atol=error)
    np.testing.assert_allclose(state.plan[:, 0], [0.4, 0.3, 0.2, 0.1, 0], atol=error)
    v = 0.1 * np.arange(5, 0, -1)
    best = (0.1 * np.cumsum(v)).sum() - 0.5 * (v**2).sum()
    assert float(metrics["planner/planned_return"]) == pytest.approx(best, abs=0.02)


@pytest.mark.parametrize("name", ["gradient", "refits"])
def test_disagreement_costs_its_price(name: str) -> None:
    """J rises by 0.5 per u in the first decision; a price above that keeps u at 0."""
    more = {"iterations": 12} if name == "gradient" else {"refits": 8}
    (still, *_), (moving, state, metrics) = (
        act(planner(name, Doubted(), speed(), **more, disagreement_price=price))
        for price in (1.0, 0.0)
    )
    assert abs(float(still[0])) < 0.1 < 0.5 < float(moving[0])
    if name == "gradient":
        mean = np.abs([moving, *state.plan[:-1]]).mean()
        assert float(metrics["planner/disagreement"]) == pytest.approx(mean, rel=1e-5)


FAILING = [
    *(("refits", {"elites": elites}) for elites in (16, 128)),  # fewer than are finite, and more
    *(
        ("sampling", {"execute": execute, "temperature": 0.01})
        for execute in ("mean", "sample", "best")
    ),
]


@pytest.mark.parametrize(("name", "fields"), [("gradient", {"noise": 0.3}), *FAILING])
def test_a_candidate_that_breaks_the_model_does_not_act(name: str, fields: dict) -> None:
    """J rises with u up to where the model gives NaN, as a simulator does that is unstable.

    Of the gradient planner, whose gain may be none there, with u below -0.05.
    """
    model = Breaking(low=-0.05) if name == "gradient" else Breaking(high=0.2)
    u, state, metrics = act(planner(name, model, speed(), horizon=2, **fields))
    least = -1 if fields.get("execute") == "sample" else 0.05
    assert least < float(u[0]) <= (1 if name == "gradient" else 0.2)
    assert np.isfinite(state.plan).all()
    assert np.isfinite([float(value) for value in metrics.values()]).all()


@pytest.mark.parametrize(("name", "fields"), FAILING)
def test_a_decision_without_a_plan_does_not_spoil_the_next(name: str, fields: dict) -> None:
    """As after one observation of a sensor that failed: its own action is NaN."""
    rest = {"rest": 0.2} if name == "sampling" else {}
    made = planner(name, objective=speed(), **fields, **rest)
    u, state, _ = act(made, jnp.full(2, jnp.nan))
    assert np.isnan(u).all()
    np.testing.assert_array_equal(state.plan, np.full((T, 1), rest.get("rest", 0), np.float32))
    assert np.isfinite(act(made, state=state, key=1)[0]).all()


@pytest.mark.parametrize("name", ["shooting", "gradient", "refits", "sampling"])
def test_the_objective_gets_the_previous_action(name: str) -> None:
    """It is zero at the first decision."""
    made, u = planner(name), jnp.zeros(1)
    state, decide = made.init(SPEC), jax.jit(made.act)
    for _ in range(3):
        before = u
        u, state, _ = decide(Params(), state, jnp.zeros(2), jax.random.key(0))
        np.testing.assert_array_equal(state.memory, before)
    assert u.any()


@pytest.mark.parametrize(
    ("name", "fields"),
    [
        ("shooting", {"iterations": 20}),
        ("gradient", {}),
        ("refits", {"samples": 32, "elites": 8}),
        ("sampling", {"samples": 32, "temperature": 0.1, "normalise": True, "execute": "best"}),
    ],
)
def test_on_the_pendulum_a_plan_is_better_than_no_action(name: str, fields: dict) -> None:
    """By the rewards of the environment; and what evaluations do is decided by the key alone."""
    world = Pendulum()
    objective = PredictedReturn(KnownReward(world))
    made = planner(name, Exact(world), objective, horizon=10, **fields).greedy()
    first = jax.jit(world.reset)(jax.random.key(0))

    @jax.jit
    def total(plan: Any) -> Any:
        return jax.lax.scan(lambda s, u: ((s := world.step(s, u)), s.reward), first, plan)[1].sum()

    @jax.jit
    def decide(state: Any) -> tuple:
        return made.act(Params(), state, first.obs, jax.random.key(1))

    begin = made.init(world.spec)
    u, state, _ = decide(begin)
    assert np.abs(u).max() <= 1
    plan = jnp.concatenate([u[None], state.plan[:-1]])
    assert float(total(plan)) > float(total(0 * plan)) + 0.5
    np.testing.assert_array_equal(u, decide(begin)[0])
