"""Controllers around an equilibrium: KL-E3, its guard, and the goal controller."""

from dataclasses import dataclass, replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from toys import Goal

from hybrid_rl.controllers.adjoint import AdjointController
from hybrid_rl.controllers.goal import GoalController
from hybrid_rl.controllers.guarded import GuardedController
from hybrid_rl.core import adjoint
from hybrid_rl.core.domain import Box
from hybrid_rl.envs.analytic.cart_double_pendulum import CartDoublePendulum
from hybrid_rl.models.exact import Exact
from hybrid_rl.models.local_linear import LocalLinear
from hybrid_rl.policies.regulator import Regulator
from hybrid_rl.types import Params

WORLD = CartDoublePendulum()
PI = Regulator(WORLD, (5.0, 50.0, 50.0, 20.0, 700.0, 700.0), (1600.0,))
START = jnp.array([0.3, 0.02, -0.01, 0.0, 0.1, 0.0])


RIGHT = Goal(lambda path: jnp.sum(path.x[:, 0]))  # J = sum of the cart's positions

KLE3 = AdjointController(LocalLinear(WORLD), RIGHT, PI, 8, gain=5.0, lyapunov=PI)


def follow(controller: Any, decisions: int, x: Array = START) -> tuple:
    """Observations [T, 6], actions [T, 1], controller states and metrics [T]."""

    def decide(carry: tuple, key: Array) -> tuple:
        x, state = carry
        u, after, metrics = controller.act(Params(), state, x, key)
        return (WORLD.dynamics(x, u), after), (x, u, after, metrics)

    keys = jax.random.split(jax.random.key(0), decisions)
    first = (x, controller.init(WORLD.spec))
    return jax.jit(lambda: jax.lax.scan(decide, first, keys)[1])()


def decide(controller: Any) -> tuple:
    """One decision at the start."""
    key = jax.random.key(0)
    return jax.jit(controller.act)(Params(), controller.init(WORLD.spec), START, key)


def own(x: Array) -> Array:
    """The regulator's actions at x [T, 6]."""
    return jax.vmap(lambda x: PI.mean((), x))(x)


def test_the_correction_is_that_of_the_thesis() -> None:
    """u = pi + R^-1 h' rho, with h the model's control directions over a decision."""
    model = LocalLinear(WORLD)

    def step(x: Array, u: Array) -> Array:
        return model.step((), x, u)

    @jax.jit
    def wanted() -> Array:
        path = adjoint.roll(step, lambda x: PI.mean((), x), START, jnp.zeros((8, 1)))
        around = adjoint.adjoint(step, lambda x: PI.mean((), x), RIGHT.value, path)
        h = jax.jacfwd(step, argnums=1)(START, path.u[0])
        return path.u[0] + 5.0 * h.T @ around.costate[1]

    np.testing.assert_allclose(decide(KLE3)[0], wanted(), rtol=1e-5)


def test_horizon_adds_its_plan_to_the_policy_at_the_measured_state() -> None:
    """A plan is made every 8 decisions and then followed."""
    x, u, state, _ = follow(replace(KLE3, apply="horizon"), 16)
    np.testing.assert_array_equal(state.more, np.arange(1, 17))
    np.testing.assert_array_equal(state.memory[1:], u[:-1])  # also between two plans
    for start in (0, 8):
        plan = state.plan[start]
        held = u[start + 1 : start + 8] - own(x[start + 1 : start + 8])
        np.testing.assert_allclose(held, plan[:-1], atol=1e-5)
        assert np.abs(plan).max() > 1e-4


def test_search_keeps_the_best_window() -> None:
    """By the model its return is at least that of the whole plan, of which it is one part."""
    plans = {name: decide(replace(KLE3, apply=name)) for name in ("search", "horizon")}
    returns = {name: float(p[2]["planner/planned_return"]) for name, p in plans.items()}
    assert returns["search"] >= returns["horizon"]
    searched, whole = (np.asarray(plans[name][1].plan) for name in ("search", "horizon"))
    on = (searched != 0).ravel()
    np.testing.assert_array_equal(searched[on], whole[on])
    assert np.sum(np.diff(on.astype(int)) == 1) <= 1  # one window


def test_search_is_never_worse_than_no_correction() -> None:
    """If every part of the plan overshoots, none is executed."""
    gentle = Goal(lambda path: -jnp.sum((path.u - 0.1) ** 2))
    for gain, acts in ((100.0, False), (0.5, True)):
        given = {"objective": gentle, "policy": None, "lyapunov": None, "apply": "search"}
        wild = replace(KLE3, gain=gain, **given)
        u, state, metrics = decide(wild)
        assert np.asarray([u, *state.plan]).any() == acts
        wanted = 0 if acts else -8 * 0.1**2
        assert float(metrics["planner/planned_return"]) == pytest.approx(wanted, abs=1e-6)


def test_lyapunov_metrics_follow_their_definitions() -> None:
    """V, its change under the policy, and the bound, with the exact model."""
    controller = replace(KLE3, model=Exact(WORLD), horizon=3)
    first, state, metrics = decide(controller)
    flow, mean = jax.jit(WORLD.dynamics), jax.jit(lambda x: PI.mean((), x))
    P = PI.solve()[1]

    def value(x: Array) -> float:
        return float(np.float64(x) @ P @ np.float64(x))

    after = flow(START, mean(START))
    assert float(metrics["planner/lyapunov"]) == pytest.approx(value(START), rel=1e-4)
    rate = value(after) - value(START)
    assert float(metrics["planner/lyapunov_rate"]) == pytest.approx(rate, rel=0.02)
    assert rate < 0
    x, apart = START, []
    for v in (first - mean(START), *state.plan[:-1]):
        u = mean(x)
        apart.append(value(flow(x, u + v)) - value(flow(x, u)))
        x = flow(x, u + v)
    assert float(metrics["planner/lyapunov_bound"]) == pytest.approx(max(apart), abs=0.02)


def test_the_guard_keeps_the_state_in_its_level_set() -> None:
    """V stays below the level while corrections still act; with an infinite level V exceeds it."""
    level, near = 100.0, 0.2 * START
    free = replace(KLE3, model=Exact(WORLD), gain=10.0, horizon=3)
    guarded = GuardedController(free, free.model, PI)
    run = jax.jit(lambda level: follow(replace(guarded, level=level), 300, near))
    x, u, _, metrics = run(level)
    handed = np.asarray(metrics["planner/handed_over"]) > 0
    assert float(metrics["planner/lyapunov"][0]) < level
    assert np.max(metrics["planner/lyapunov"]) <= level * (1 + 1e-4)
    np.testing.assert_array_equal(u[handed], own(x)[handed])
    assert 0 < handed.sum() < 300
    assert np.nanmax(run(np.inf)[3]["planner/lyapunov"]) > level


@dataclass(frozen=True)
class Peak:
    """log p(s) = -|s - 0.4|."""

    def log_density(self, params: Any, s: Array) -> Array:
        return -jnp.abs(s[0] - 0.4)


def test_the_goal_is_the_maximum_of_the_target() -> None:
    """Without a policy the action is the goal; a policy drives there and gets a new one in time."""
    there = GoalController(Peak(), Box(low=(-1.0,), high=(3.0,)))
    u, goal, _ = decide(there)
    assert float(goal.s[0]) == pytest.approx(0.4, abs=0.02)
    assert float(u[0]) == pytest.approx((0.4 + 1) / 2 - 1, abs=0.01)
    x, _, state, _ = follow(GoalController(Peak(), Box(), PI, every=50), 1500, 0 * START)
    assert float(x[-1, 0]) == pytest.approx(0.4, abs=0.03)
    assert len(np.unique(state.s)) == 30  # drawn every 50 decisions


def test_the_goal_is_the_end_of_the_best_way() -> None:
    """The mean of 4 positions at quarters of the way is start + 0.625 (s - start)."""

    @dataclass(frozen=True)
    class Middle:
        def along(self, params: Any, path: Array) -> Array:
            return -jnp.abs(path[:, 0].mean() - 0.5)

    there = GoalController(Middle(), Box(low=(-1.0,), high=(3.0,)), ahead=4)
    _, goal, _ = decide(there)
    assert float(goal.s[0]) == pytest.approx(0.3 + (0.5 - 0.3) / 0.625, abs=0.02)
