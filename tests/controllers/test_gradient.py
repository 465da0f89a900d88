"""The gradient planner on a mass on a line, with known solutions."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from toys import SPEC, Acting, Cart, Goal, speed

from hybrid_rl.controllers.gradient import GradientController
from hybrid_rl.types import Params

SMALL: dict[str, Any] = {"horizon": 5, "tail": 0, "samples": 8, "refined": 2}
STEADY = Acting(-0.5, brake=1.0)


def act(controller: GradientController, obs: tuple[float, float] = (0.0, 0.0)) -> tuple:
    """One decision."""
    state = controller.init(SPEC)
    return jax.jit(controller.act)(Params(), state, jnp.array(obs), jax.random.key(0))


def test_the_path_that_acts_is_among_the_considered() -> None:
    """It begins at the state, with the action; all candidates are there, and no u is beyond 1."""
    goal = speed(0.5)
    planner = GradientController(Cart(), goal, **SMALL, noise=1.0)
    given = Params(), planner.init(SPEC), jnp.array((0.2, -0.1)), jax.random.key(0)
    both = jax.jit(lambda *of: (planner.considered(*of), planner.act(*of)[0]))
    (u, _, metrics, found), acts = both(*given)
    np.testing.assert_array_equal(u, acts)
    assert found.paths.x.shape == (1 + 2 * (2 + 1) + 8, 6, 2)  # what acts, refined, starts, drawn
    np.testing.assert_allclose(found.paths.x[:, 0], np.tile([0.2, -0.1], (15, 1)), atol=1e-6)
    chosen = jax.tree.map(lambda leaf: leaf[found.chosen], found.paths)
    np.testing.assert_array_equal(chosen.u[0], u)
    assert np.abs(found.paths.u).max() == 1
    assert float(metrics["planner/gain"]) > 0
    value = float(goal.value(chosen))
    assert float(metrics["planner/planned_return"]) == pytest.approx(value, abs=1e-5)


def test_strength_is_chosen_by_the_goal() -> None:
    """At speed 1 the policy brakes by 1.5; for standing still less is wanted near rest."""
    still = Goal(lambda path: -jnp.sum(path.x[1:, 1] ** 2))
    given = {**SMALL, "quiet": 1.0, "iterations": 0, "strengths": (1.0, 0.5)}
    planner = GradientController(Cart(), still, STEADY, **given)
    _, fast, _ = act(planner, (0.0, 1.0))
    _, slow, _ = act(planner, (0.0, 0.0))
    assert (float(fast.more), float(slow.more)) == (1.0, 0.5)


@pytest.mark.parametrize(("doubt", "pushes"), [(None, True), (0.9, True), (1.1, False)])
def test_a_plan_acts_where_the_members_agree_that_it_beats_the_policy(doubt, pushes) -> None:
    """One member gains from a push to the right what two mean, the other nothing: mean = std."""

    @dataclass(frozen=True)
    class Torn(Cart):
        def predictions(self, params: Any, x: Array, u: Array) -> tuple[Array, Array, Array]:
            after, still = self.step(params, x, u), self.step(params, x, jnp.zeros(1))
            return after, jnp.zeros(2), jnp.stack([still, 2 * after - still])

    idle = Acting(0.0, brake=1.0)
    u = act(GradientController(Torn(), speed(), idle, **SMALL, noise=0.3, doubt=doubt))[0]
    assert (float(u[0]) > 0.2) == pushes


def test_noise_is_as_large_at_each_decision_and_correlated_with_that_before() -> None:
    """Covariance noise^2 c^|i - j| over the candidates."""
    given: dict[str, Any] = {"horizon": 4, "samples": 4000, "noise": 0.2, "correlation": 0.8}
    planner = GradientController(Cart(), speed(), **given)
    v = planner._drawn(planner.init(SPEC), jax.random.key(0)).v[..., 0]
    apart = np.abs(np.subtract.outer(np.arange(4), np.arange(4)))
    np.testing.assert_allclose(np.cov(np.asarray(v).T), 0.04 * 0.8**apart, atol=0.004)


def test_the_tail_sees_what_comes_after_the_plan() -> None:
    """One decision ahead, speed pays; for ten more it costs, and the policy has to brake."""
    late = Goal(lambda path: path.x[1, 1] - 3 * jnp.sum(jnp.abs(path.x[2:, 1])))
    given = {**SMALL, "horizon": 1, "strengths": (0.0,), "disagreement_price": 0.0}
    short, long = (
        act(GradientController(Cart(), late, STEADY, **{**given, "tail": tail}))[0]
        for tail in (0, 10)
    )
    assert float(short[0]) > 0.2
    assert abs(float(long[0])) < 0.1
