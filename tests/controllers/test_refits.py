"""The planner by refits on a mass on a line, with known solutions."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from test_adjoint_controller import SPEC, Cart, Speed
from test_gradient import Doubted

from hybrid_rl.controllers.refits import RefitsController
from hybrid_rl.proposals.policy import PolicyProposal
from hybrid_rl.types import Params


@dataclass(frozen=True)
class Breaking(Cart):
    """The mass on a line, of which nothing is known beyond u = 0.2."""

    def step(self, params: Any, x: Array, u: Array) -> Array:
        """The next state [2]."""
        return jnp.where(u[0] > 0.2, jnp.nan, super().step(params, x, u))


@dataclass(frozen=True)
class Right:
    """A policy that pushes with 0.9."""

    def sample(self, params: Any, x: Array, noise: Array) -> tuple[Array, Array]:
        """0.9, whatever the noise."""
        return jnp.full(1, 0.9), jnp.zeros(())


def act(controller: RefitsController) -> tuple:
    """One decision."""
    state = controller.init(SPEC)
    return jax.jit(controller.act)(Params(), state, jnp.zeros(2), jax.random.key(0))


def test_refits_reach_the_best_actions() -> None:
    """J of speeds less 0.5 u^2 has its greatest value at u = 0.1 n, n decisions before the end."""
    planner = RefitsController(Cart(), Speed(0.5), horizon=5, refits=12, disagreement_price=0)
    u, state, metrics = act(planner)
    np.testing.assert_allclose(u, 0.5, atol=0.06)
    np.testing.assert_allclose(state.plan[:4, 0], [0.4, 0.3, 0.2, 0.1], atol=0.06)
    assert float(metrics["planner/spread"]) == pytest.approx(0.05, abs=0.03)


def test_candidates_of_the_policy_are_among_them() -> None:
    """One refit to the best candidate: noise of 0.05 around 0 is far from the policy's 0.9."""
    given: dict[str, Any] = {"horizon": 5, "refits": 1, "elites": 1, "spread": 0.05}
    alone = RefitsController(Cart(), Speed(), **given)
    both = RefitsController(Cart(), Speed(), PolicyProposal(Right()), **given)
    assert float(act(alone)[0][0]) < 0.3
    assert float(act(both)[0][0]) == pytest.approx(0.9)


def test_disagreement_costs_its_price() -> None:
    """J rises by 0.5 per u in the first decision; a price above that keeps u at 0."""
    still, moving = (
        act(RefitsController(Doubted(), Speed(), horizon=5, refits=8, disagreement_price=price))[0]
        for price in (1.0, 0.0)
    )
    assert abs(float(still[0])) < 0.1 < 0.5 < float(moving[0])


def test_the_planned_return_is_that_of_the_objective_without_the_price() -> None:
    """Of the only candidate, from rest: J = 0.1 u_0 + 0.1 (u_0 + u_1)."""
    one: dict[str, Any] = {"horizon": 2, "samples": 1, "elites": 1, "refits": 1}
    u, state, metrics = act(RefitsController(Doubted(), Speed(), **one, disagreement_price=9.0))
    wanted = 0.2 * float(u[0]) + 0.1 * float(state.plan[0, 0])
    assert float(metrics["planner/planned_return"]) == pytest.approx(wanted, abs=1e-6)


def test_candidates_whose_prediction_is_not_finite_rank_last() -> None:
    """J rises with u up to 0.2, beyond which the model gives NaN."""
    u, state, _ = act(RefitsController(Breaking(), Speed(), horizon=2))
    assert np.isfinite(state.plan).all()
    assert 0.1 < float(u[0]) <= 0.2


def test_more_elites_than_candidates_are_refused() -> None:
    with pytest.raises(ValueError, match="elites=9: must be at most samples=8"):
        RefitsController(Cart(), Speed(), samples=8, elites=9)
