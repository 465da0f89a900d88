"""The adjoint planner on problems with known solutions."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import SPEC, Acting, Cart, speed

from hybrid_rl.controllers.adjoint import AdjointController
from hybrid_rl.types import Params

HALF = Acting(-0.2)
REST = jnp.zeros(2), jax.random.key(0)


def act(controller: AdjointController, decisions: int | None = 0) -> tuple:
    """One decision of a cart at rest."""
    params = Params() if decisions is None else Params(decisions=jnp.asarray(decisions))
    return jax.jit(controller.act)(params, controller.init(SPEC), *REST)


def test_one_step_is_the_closed_form() -> None:
    """The action is mu + Sigma g: an action adds 0.1 to T later speeds, so g = 0.1 T."""
    for horizon in (1, 5):
        u, _, metrics = act(AdjointController(Cart(), speed(), HALF, horizon))
        correction = 0.25 * 0.1 * horizon
        assert float(u[0]) == pytest.approx(-0.2 + correction, abs=1e-6)
        got = float(metrics["planner/mode_insertion_gradient"])
        assert got == pytest.approx(0.1 * horizon * correction, abs=1e-6)
        share = 0.2 / (0.2 + correction)
        assert float(metrics["planner/policy_share"]) == pytest.approx(share, abs=1e-5)
    u, state, _ = act(AdjointController(Cart(), speed(), HALF, 5, gain=0.3, normalise=True))
    v, n = [u + 0.2, *state.plan[:-1]], np.arange(5, 0, -1)
    np.testing.assert_allclose(np.ravel(v), 0.3 * n / np.sqrt((n**2).mean()), rtol=1e-5)


def test_actions_stay_within_bounds() -> None:
    """Also for a large gain."""
    controller = AdjointController(Cart(), speed(), HALF, 20, iterations=5, gain=100.0)
    assert float(act(controller)[0][0]) == 1


def test_corrections_decay_with_the_decisions_of_the_episode() -> None:
    """W is multiplied by decay^decisions of the episode, not of the run; v begins at zero."""
    controller = AdjointController(Cart(), speed(), HALF, 2, gain_decay=0.5)
    params, decide, state = Params(decisions=1000), jax.jit(controller.act), controller.init(SPEC)
    for decision in range(3):
        u, state, _ = decide(params, state, *REST)
        assert float(u[0]) == pytest.approx(-0.2 + 0.5**decision * 0.25 * 0.2, abs=1e-6)


def test_corrections_decay_with_the_decisions_of_the_run() -> None:
    """W is multiplied by run_decay^decisions; where they are not counted, there is none."""
    controller = AdjointController(Cart(), speed(), HALF, 1, run_decay=0.5)
    for decisions, factor in ((0, 1.0), (2, 0.25), (None, 0.0)):
        u = act(controller, decisions)[0]
        assert float(u[0]) == pytest.approx(-0.2 + factor * 0.25 * 0.1, abs=1e-6)
