"""The planner by refits on a mass on a line, with known solutions."""

from dataclasses import dataclass, replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from test_adjoint_controller import SPEC, Cart, Speed
from test_gradient import Doubted
from test_sampling_controller import Breaking

from hybrid_rl.controllers.refits import RefitsController
from hybrid_rl.proposals.policy import PolicyProposal
from hybrid_rl.types import Params


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


def test_a_decision_is_that_of_numpy() -> None:
    """Two refits to the best three of eight candidates, of which the policy makes two."""
    given: dict[str, Any] = {"samples": 8, "elites": 3, "refits": 2, "spread": 0.8, "floor": 0.2}
    T, strong_and_weak = 4, PolicyProposal(Right(), strengths=(1.0, 0.5))
    planner = RefitsController(Doubted(), Speed(0.05), strong_and_weak, T, **given)
    planner = replace(planner, temperature=0.7, disagreement_price=0.01)
    mu, key = np.array([[0.3], [-0.2], [0.9], [0.1]]), jax.random.key(1)
    state = planner.init(SPEC)._replace(plan=jnp.asarray(mu, jnp.float32))
    u, state, metrics = jax.jit(planner.act)(Params(), state, jnp.zeros(2), key)
    sigma, own = np.full((T, 1), 0.8), np.stack([np.full((T, 1), each) for each in (0.9, 0.45)])
    for drawing in jax.random.split(jax.random.split(key, 3)[2], 2):
        e = np.asarray(jax.random.normal(drawing, (6, T, 1)))
        v = np.concatenate([own, np.clip(mu + sigma * e, -1, 1)])
        J = np.cumsum(0.1 * v, 1).sum((1, 2)) - 0.05 * (v**2).sum((1, 2))
        S = J - 0.01 * np.abs(v).sum((1, 2))
        best = np.argsort(-S)[:3]
        w = np.exp(S[best] / S[best].std() / 0.7)
        w = (w / w.sum())[:, None, None]
        mu = (w * v[best]).sum(0)
        sigma = np.clip(np.sqrt((w * (v[best] - mu) ** 2).sum(0)), 0.2, 0.8)
    np.testing.assert_allclose(u, mu[0], rtol=1e-4)
    np.testing.assert_allclose(state.u, mu[0], rtol=1e-4)
    np.testing.assert_allclose(state.plan, [*mu[1:], [0]], atol=1e-5)
    assert float(metrics["planner/planned_return"]) == pytest.approx(J[best[0]], rel=1e-4)
    assert float(metrics["planner/spread"]) == pytest.approx(sigma[0, 0], rel=1e-4)


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
    for elites in (16, 128):  # fewer than are finite, and more
        u, state, _ = act(RefitsController(Breaking(), Speed(), horizon=2, elites=elites))
        assert np.isfinite(state.plan).all()
        assert 0.05 < float(u[0]) <= 0.2


def test_more_elites_than_candidates_are_refused() -> None:
    with pytest.raises(ValueError, match="elites=9: must be at most samples=8"):
        RefitsController(Cart(), Speed(), samples=8, elites=9)
