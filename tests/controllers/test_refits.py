"""The planner by refits against NumPy."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import SPEC, Acting, Doubted, speed

from hybrid_rl.controllers.refits import RefitsController
from hybrid_rl.proposals.policy import PolicyProposal
from hybrid_rl.types import Params


def test_a_decision_is_that_of_numpy() -> None:
    """Two refits to the best three of eight candidates, of which the policy makes two.

    The planned return is that of the objective, without the price of disagreement.
    """
    given: dict[str, Any] = {"samples": 8, "elites": 3, "refits": 2, "spread": 0.8, "floor": 0.2}
    given |= {"temperature": 0.7, "disagreement_price": 0.01}
    T, strong_and_weak = 4, PolicyProposal(Acting(0.9), strengths=(1.0, 0.5))
    planner = RefitsController(Doubted(), speed(0.05), strong_and_weak, T, **given)
    mu, key = np.array([[0.3], [-0.2], [0.9], [0.1]]), jax.random.key(1)
    state = planner.init(SPEC)._replace(plan=jnp.asarray(mu, jnp.float32))
    u, state, metrics = jax.jit(planner.act)(Params(), state, jnp.zeros(2), key)
    sigma, own = np.full((T, 1), 0.8), np.stack([np.full((T, 1), mean) for mean in (0.9, 0.45)])
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
