"""The gradient planner on a mass on a line, with known solutions."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from test_adjoint_controller import SPEC, Cart, Speed

from hybrid_rl.controllers.gradient import GradientController
from hybrid_rl.fields import FieldError
from hybrid_rl.models.world import World
from hybrid_rl.types import Params


@dataclass(frozen=True)
class Doubted(Cart):
    """The mass, whose members disagree by |u| in every entry."""

    def predictions(self, params: Any, x: Array, u: Array) -> tuple[Array, Array, Array]:
        """The next state, the disagreement, and the only member's prediction."""
        after = self.step(params, x, u)
        return after, jnp.full(2, jnp.abs(u).sum()), after[None]


@dataclass(frozen=True)
class Steady:
    """A policy that pushes back with 0.5 and brakes at high speed."""

    def mean(self, params: Any, x: Array) -> Array:
        """-0.5, less at speed."""
        return jnp.full(1, -0.5) - x[1]

    def variance(self, params: Any, x: Array) -> Array:
        """Constant."""
        return jnp.full(1, 0.25)


@dataclass(frozen=True)
class Still:
    """J = -sum of squared speeds."""

    def init(self, spec: Any) -> tuple[()]:
        """No memory."""
        return ()

    def prepare(self, params: Any, memory: Any, x: Array, u_before: Array, key: Array) -> tuple:
        """J of a path."""
        return lambda path: -jnp.sum(path.x[1:, 1] ** 2), memory


def act(controller: GradientController, obs: tuple[float, float] = (0.0, 0.0)) -> tuple:
    """One decision."""
    state = controller.init(SPEC)
    return jax.jit(controller.act)(Params(), state, jnp.array(obs), jax.random.key(0))


SMALL: dict[str, Any] = {"horizon": 5, "tail": 0, "samples": 8, "refined": 2}


def test_without_a_policy_it_reaches_the_best_action() -> None:
    """J of speeds less 0.5 u^2 has its greatest value at u = 0.1 n, n decisions before the end."""
    planner = GradientController(
        Cart(), Speed(0.5), **SMALL, iterations=60, step=0.01, noise=0.2, disagreement_price=0
    )
    u, state, metrics = act(planner)
    np.testing.assert_allclose(u, 0.5, atol=0.03)
    np.testing.assert_allclose(state.plan[:4, 0], [0.4, 0.3, 0.2, 0.1], atol=0.03)
    assert float(metrics["planner/gain"]) > 0


def test_the_path_that_acts_is_among_the_considered() -> None:
    """It begins at the state, with the action; all candidates are there, and no u is beyond 1."""
    planner = GradientController(Cart(), Speed(0.5), **SMALL, noise=1.0)
    given = Params(), planner.init(SPEC), jnp.array((0.2, -0.1)), jax.random.key(0)
    both = jax.jit(lambda *of: (planner.considered(*of), planner.act(*of)[0]))
    (u, _, metrics, found), acts = both(*given)
    np.testing.assert_array_equal(u, acts)
    assert found.paths.x.shape == (1 + 2 * (2 + 1) + 8, 6, 2)  # what acts, refined, starts, drawn
    np.testing.assert_allclose(found.paths.x[:, 0], np.tile([0.2, -0.1], (15, 1)), atol=1e-6)
    chosen = jax.tree.map(lambda leaf: leaf[found.chosen], found.paths)
    np.testing.assert_array_equal(chosen.u[0], u)
    assert np.abs(found.paths.u).max() == 1
    assert float(metrics["planner/planned_return"]) == pytest.approx(value_of(chosen), abs=1e-5)


def value_of(path: Any) -> float:
    """J of a path."""
    value, _ = Speed(0.5).prepare(Params(), (), path.x[0], jnp.zeros(1), jax.random.key(0))
    return float(value(path))


def test_disagreement_costs_its_price() -> None:
    """J rises by 0.5 per u in the first decision; a price above that keeps u at 0."""
    (still, *_), (moving, state, metrics) = (
        act(
            GradientController(Doubted(), Speed(), **SMALL, iterations=12, disagreement_price=price)
        )
        for price in (1.0, 0.0)
    )
    assert abs(float(still[0])) < 0.1 < 0.5 < float(moving[0])
    mean = np.abs([moving, *state.plan[:4]]).mean()
    assert float(metrics["planner/disagreement"]) == pytest.approx(mean, rel=1e-5)


def test_strength_is_chosen_by_the_goal() -> None:
    """At speed 1 the policy brakes by 1.5; for standing still less is wanted near rest."""
    planner = GradientController(
        Cart(), Still(), policy=Steady(), **SMALL, quiet=1.0, iterations=0, strengths=(1.0, 0.5)
    )
    _, fast, _ = act(planner, (0.0, 1.0))
    _, slow, _ = act(planner, (0.0, 0.0))
    assert (float(fast.more), float(slow.more)) == (1.0, 0.5)


@pytest.mark.parametrize(("doubt", "pushes"), [(None, True), (0.9, True), (1.1, False)])
def test_a_plan_acts_where_the_members_agree_that_it_beats_the_policy(
    doubt: float | None, pushes: bool
) -> None:
    """One member gains from a push to the right what two mean, the other nothing: mean = std."""

    @dataclass(frozen=True)
    class Torn(Cart):
        def predictions(self, params: Any, x: Array, u: Array) -> tuple[Array, Array, Array]:
            """The mean, no disagreement, and what either member predicts."""
            after, still = self.step(params, x, u), self.step(params, x, jnp.zeros(1))
            return after, jnp.zeros(2), jnp.stack([still, 2 * after - still])

    @dataclass(frozen=True)
    class Idle(Steady):
        def mean(self, params: Any, x: Array) -> Array:
            """No action."""
            return jnp.zeros(1)

    u = act(GradientController(Torn(), Speed(), policy=Idle(), **SMALL, noise=0.3, doubt=doubt))[0]
    assert (float(u[0]) > 0.2) == pushes


def test_noise_is_as_large_at_each_decision_and_correlated_with_that_before() -> None:
    """Covariance noise^2 c^|i - j| over the candidates."""
    given: dict[str, Any] = {"horizon": 4, "samples": 4000, "noise": 0.2, "correlation": 0.8}
    planner = GradientController(Cart(), Speed(), **given)
    v = planner._drawn(planner.init(SPEC), jax.random.key(0)).v[..., 0]
    apart = np.abs(np.subtract.outer(np.arange(4), np.arange(4)))
    np.testing.assert_allclose(np.cov(np.asarray(v).T), 0.04 * 0.8**apart, atol=0.004)


def test_each_strength_is_drawn_with_and_without_noise() -> None:
    """Twelve candidates, half of them quiet: three of each strength and kind."""
    given: dict[str, Any] = {**SMALL, "samples": 12, "strengths": (1.0, 0.5), "quiet": 0.5}
    planner = GradientController(Cart(), Speed(), policy=Steady(), **given)
    drawn = jax.jit(planner._drawn)(planner.init(SPEC), jax.random.key(0))
    noisy = np.asarray(drawn.v).any((1, 2))
    for s in (1.0, 0.5):
        assert sorted(noisy[drawn.s == s]) == [False] * 3 + [True] * 3


def test_the_tail_sees_what_comes_after_the_plan() -> None:
    """One decision ahead, speed pays; for ten more the policy has to brake at J's expense."""

    @dataclass(frozen=True)
    class Late(Still):
        def prepare(self, params: Any, memory: Any, x: Array, u: Array, key: Array) -> tuple:
            """J pays for speed at once, and takes more for it later."""
            return lambda path: path.x[1, 1] - 3 * jnp.sum(jnp.abs(path.x[2:, 1])), memory

    given = {**SMALL, "horizon": 1, "strengths": (0.0,), "disagreement_price": 0.0}
    short, long = (
        act(GradientController(Cart(), Late(), Steady(), **{**given, "tail": tail}))[0]
        for tail in (0, 10)
    )
    assert float(short[0]) > 0.2
    assert abs(float(long[0])) < 0.1


def test_a_candidate_that_leaves_all_bounds_does_not_act() -> None:
    """NaN returns neither win nor spoil gradients."""

    @dataclass(frozen=True)
    class Broken(Cart):
        def step(self, params: Any, x: Array, u: Array) -> Array:
            """NaN for a push to the left."""
            return super().step(params, x, u) + jnp.where(u[0] < -0.05, jnp.nan, 0.0)

    u, _, metrics = act(GradientController(Broken(), Speed(), **SMALL, noise=0.3))
    assert float(u[0]) > 0
    assert np.isfinite([float(value) for value in metrics.values()]).all()


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"horizon": 0}, "horizon=0: must be a whole number, 1 or more"),
        ({"strengths": (1.0, -0.5)}, "strengths=.*: must be 0 or more"),
        ({"step": 0.0}, "step=0.0: must be above 0"),
        ({"disagreement_price": -1.0}, "disagreement_price=-1.0: must be 0 or more"),
    ],
)
def test_fields_out_of_range_are_refused(fields: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        GradientController(Cart(), Speed(), **fields)


def test_the_world_itself_is_refused() -> None:
    """No gradient goes through it."""
    with pytest.raises(FieldError, match="model=World: has no gradients; choose model=exact"):
        GradientController(World(Cart()), Still())
