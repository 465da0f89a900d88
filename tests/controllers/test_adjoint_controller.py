"""The adjoint controller on problems with known solutions."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.controllers.adjoint import AdjointController
from hybrid_rl.types import Params, Spec

SPEC = Spec(obs=2, act=1, dt=0.1)


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
class Speed:
    """J = sum of speeds - price * sum of u^2."""

    price: float = 0.0

    def init(self, spec: Spec) -> tuple[()]:
        """No memory."""
        return ()

    def prepare(self, params: Any, memory: Any, x: Array, u_before: Array, key: Array) -> tuple:
        """J of a path."""
        return lambda path: jnp.sum(path.x[1:, 1]) - self.price * jnp.sum(path.u**2), memory


@dataclass(frozen=True)
class Half:
    """A policy of mean -0.2 and of variance 0.25."""

    def mean(self, params: Any, x: Array) -> Array:
        """Constant."""
        return jnp.full(1, -0.2)

    def variance(self, params: Any, x: Array) -> Array:
        """Constant."""
        return jnp.full(1, 0.25)


def act(controller: AdjointController, decisions: int = 0, key: int = 0) -> tuple:
    """One decision of a cart at rest."""
    params = Params(decisions=jnp.asarray(decisions))
    key = jax.random.key(key)
    return jax.jit(controller.act)(params, controller.init(SPEC), jnp.zeros(2), key)


def actions(controller: AdjointController, keys: int, decisions: int = 0) -> Array:
    """Actions [keys], one for each of as many random keys."""
    one = jax.vmap(lambda key: act(controller, decisions, key)[0][0])
    return jax.jit(one)(jnp.arange(keys))


def test_one_step_is_the_closed_form() -> None:
    """The action is mu + Sigma g: an action adds 0.1 to T later speeds, so g = 0.1 T."""
    for horizon in (1, 5):
        controller = AdjointController(Cart(), Speed(), Half(), horizon)
        u, _, metrics = act(controller)
        assert float(u[0]) == pytest.approx(-0.2 + 0.25 * 0.1 * horizon, abs=1e-6)
        inserted = 0.1 * horizon * (0.25 * 0.1 * horizon)
        got = float(metrics["planner/mode_insertion_gradient"])
        assert got == pytest.approx(inserted, abs=1e-6)
        share = 0.2 / (0.2 + 0.25 * 0.1 * horizon)
        assert float(metrics["planner/policy_share"]) == pytest.approx(share, abs=1e-5)
    normalised = AdjointController(Cart(), Speed(), Half(), 5, gain=0.3, normalise=True)
    u, state, _ = act(normalised)
    v, each = [u + 0.2, *state.plan[:-1]], np.arange(5, 0, -1)
    np.testing.assert_allclose(np.ravel(v), 0.3 * each / np.sqrt((each**2).mean()), rtol=1e-5)


def test_shooting_finds_the_optimum() -> None:
    """For sum of speeds - u^2: u_t = 0.1 (T - t) / 2, after many small steps."""
    horizon = 6
    controller = AdjointController(
        Cart(), Speed(price=1.0), horizon=horizon, iterations=200, gain=0.1
    )
    u, (plan, *_), _ = act(controller)
    wanted = 0.05 * np.arange(horizon, 0, -1)
    np.testing.assert_allclose(plan[:, 0], [*wanted[1:], 0], atol=1e-5)
    assert float(u[0]) == pytest.approx(wanted[0], abs=1e-5)


def test_actions_stay_within_bounds() -> None:
    """Also for a large gain."""
    controller = AdjointController(Cart(), Speed(), Half(), 20, iterations=5, gain=100.0)
    assert float(jnp.abs(actions(controller, 20)).max()) <= 1


def test_corrections_decay_with_the_decisions_of_the_episode() -> None:
    """W is multiplied by decay^decisions of the episode, not of the run; v begins at zero."""
    controller = AdjointController(Cart(), Speed(), Half(), 2, gain_decay=0.5)
    state, params = controller.init(SPEC), Params(decisions=jnp.asarray(1000))
    decide = jax.jit(controller.act)
    for decision in range(3):
        u, state, _ = decide(params, state, jnp.zeros(2), jax.random.key(0))
        assert float(u[0]) == pytest.approx(-0.2 + 0.5**decision * 0.25 * 0.2, abs=1e-6)


def test_corrections_decay_with_the_decisions_of_the_run() -> None:
    """W is multiplied by run_decay^decisions; where they are not counted, there is none."""
    controller = AdjointController(Cart(), Speed(), Half(), 1, run_decay=0.5)
    for decisions in range(3):
        u = act(controller, decisions)[0]
        assert float(u[0]) == pytest.approx(-0.2 + 0.5**decisions * 0.25 * 0.1, abs=1e-6)
    given = Params(), controller.init(SPEC), jnp.zeros(2), jax.random.key(0)
    assert float(jax.jit(controller.act)(*given)[0][0]) == pytest.approx(-0.2, abs=1e-6)


def test_the_objective_gets_the_previous_action() -> None:
    """It is zero at the first decision."""

    @dataclass(frozen=True)
    class Before(Speed):
        def init(self, spec: Spec) -> Array:
            return jnp.full(1, jnp.nan)

        def prepare(self, params: Any, memory: Any, x: Array, u_before: Array, key: Array) -> tuple:
            return super().prepare(params, (), x, u_before, key)[0], u_before

    controller = AdjointController(Cart(), Before(), Half(), 2)
    state, u, decide = controller.init(SPEC), jnp.zeros(1), jax.jit(controller.act)
    for _ in range(3):
        before = u
        u, state, _ = decide(Params(), state, jnp.zeros(2), jax.random.key(0))
        np.testing.assert_array_equal(state.memory, before)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"horizon": 0}, "horizon=0"),
        ({"iterations": 1.5}, "iterations=1.5"),
        ({"gain": -1.0}, "gain=-1.0"),
        ({"gain_decay": 0.0}, "gain_decay=0.0"),
        ({"policy": None}, "gain=null: needs a policy"),
    ],
)
def test_bad_fields(change, words) -> None:
    """One line that names the field."""
    with pytest.raises(ValueError, match=words):
        AdjointController(**{"model": Cart(), "objective": Speed(), "policy": Half(), **change})
