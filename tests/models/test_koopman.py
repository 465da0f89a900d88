"""Koopman models, their regression and its information, against closed forms."""

import pathlib
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.linalg import expm

from hybrid_rl.features.monomials import Monomials
from hybrid_rl.learners.least_squares import LeastSquares
from hybrid_rl.models.koopman import Koopman
from hybrid_rl.objectives.information import Information
from hybrid_rl.types import Batch, Params, Path, Spec

SPEC = Spec(obs=2, act=1, dt=0.1)
MU, LAMBDA, DT = -0.3, -1.2, 0.1
CLOSED = Koopman(Monomials(terms=((0, 0),)))  # z = (x1, x2, x1^2)
RNG = np.random.default_rng(0)


def batch(obs: np.ndarray, u: np.ndarray, after: np.ndarray) -> Batch:
    """Decisions for a learner."""
    none = jnp.zeros(len(obs))
    return Batch(jnp.asarray(obs), jnp.asarray(u), none, none, none, jnp.asarray(after))


def test_a_closed_system_has_its_exponential() -> None:
    """x1' = mu x1, x2' = lambda (x2 - x1^2), sampled exactly (Brunton et al. 2016)."""
    generator = np.array([[MU, 0, 0], [0, LAMBDA, -LAMBDA], [0, 0, 2 * MU]])
    x = RNG.uniform(-1, 1, (200, 2))
    z = np.column_stack([x, x[:, 0] ** 2]) @ expm(generator * DT).T
    with jax.enable_x64(True):
        learner = LeastSquares(CLOSED, prior=1e-12)
        state = learner.init(jax.random.key(0), SPEC)
        data = batch(x, RNG.uniform(-1, 1, (200, 1)), z[:, :2])
        state, _ = jax.jit(learner.update)(state, Params(), data, jax.random.key(0))
        K = state.model["K"]
    np.testing.assert_allclose(K[:, :3], expm(generator * DT), atol=1e-8)
    np.testing.assert_allclose(K[:, 3], 0, atol=1e-8)


def test_the_how_to_has_observables_of_an_operator() -> None:
    """z = (x, v, sin x): K has a row for each, and a column for the action, too."""
    page = (pathlib.Path(__file__).parents[2] / "docs" / "howto.md").read_text(encoding="utf-8")
    code = page.split("## Observables of your own\n")[1].split("```python\n")[1].split("```")[0]
    names: dict[str, Any] = {"__name__": "swings"}
    exec(compile(code, "howto.md", "exec"), names)
    model = Koopman(names["Swings"]())
    params = model.init(jax.random.key(0), SPEC)
    assert params["K"].shape == (3, 4)
    z = model.lift(params, jnp.array([0.5, 2.0]))
    np.testing.assert_allclose(z, [0.5, 2.0, np.sin(0.5)], rtol=1e-6)


def test_learning_ends_and_k0_is_random_in_continuous_time() -> None:
    """`until` counts decisions of the run; K_0 - [I 0] has deviation s dt, or K_0 is zero."""
    learner = LeastSquares(CLOSED, deviation=2.0, until=1)
    many = jax.jit(jax.vmap(lambda k: learner.init(k, SPEC).model["K"]))(
        jax.random.split(jax.random.key(0), 500)
    )
    np.testing.assert_allclose(many.std(0), 2.0 * SPEC.dt, rtol=0.2)
    np.testing.assert_allclose(many.mean(0), np.eye(3, 4), atol=0.05)
    state = learner.init(jax.random.key(0), SPEC)
    data = batch(*(np.ones((1, n)) for n in (2, 1, 2)))
    for decision, learns in ((0, True), (1, False)):
        params = Params(decisions=jnp.int32(decision))
        after, _ = jax.jit(learner.update)(state, params, data, jax.random.key(0))
        assert (np.abs(after.model["K"] - state.model["K"]).max() > 0) == learns
    nothing = LeastSquares(CLOSED, mean="zero").init(jax.random.key(0), SPEC).model["K"]
    np.testing.assert_allclose(nothing, 0, atol=1e-7)


def test_what_actions_do_is_recovered() -> None:
    """K of a linear system."""
    truth = RNG.normal(size=(2, 3))
    x, u = RNG.normal(size=(50, 2)), RNG.normal(size=(50, 1))
    after = np.column_stack([x, u]) @ truth.T
    with jax.enable_x64(True):
        learner = LeastSquares(Koopman(Monomials()), prior=1e-12)
        state = learner.init(jax.random.key(0), SPEC)
        state, _ = jax.jit(learner.update)(state, Params(), batch(x, u, after), jax.random.key(0))
        np.testing.assert_allclose(state.model["K"], truth, atol=1e-9)


INFORMED = Koopman(Monomials(terms=((0, 1),)))


def informed() -> dict[str, Any]:
    """Parameters of a model with some data."""
    root = np.linalg.qr(RNG.normal(size=(9, 4)))[1] + 2 * np.eye(4)
    known = {"K": RNG.normal(size=(3, 4)), "spread": np.linalg.inv(root)}
    return {**INFORMED.init(jax.random.key(0), SPEC), **jax.tree.map(jnp.asarray, known)}


@pytest.mark.parametrize("criterion", ["gain", "norm"])
def test_information_is_that_of_the_regression(criterion: str) -> None:
    """log det (U'U + s s' / sigma^2) - log det U'U, or -1 / (s's + eps); J is the sum."""
    objective = Information(INFORMED, criterion)
    with jax.enable_x64(True):
        params = Params(model=informed())
        path = Path(jnp.asarray(RNG.normal(size=(7, 3))), jnp.asarray(RNG.normal(size=(6, 1))))
        got = np.asarray(objective.rewards(params, path))
        value, _ = objective.prepare(params, (), path.x[0], path.u[0], jax.random.key(0))
        assert float(value(path)) == pytest.approx(got.sum())
        to_go = objective.reward_to_go(params, path)
        np.testing.assert_allclose(to_go, [*np.cumsum(got[::-1])[::-1], 0], rtol=1e-12)
        U = np.linalg.inv(np.asarray(params.model["spread"]))
    for x, u, r in zip(np.asarray(path.x), np.asarray(path.u), got, strict=False):
        s = np.concatenate([x, u])
        more = U.T @ U + np.outer(s, s) / 0.1**2
        gain = np.linalg.slogdet(more)[1] - np.linalg.slogdet(U.T @ U)[1]
        assert r == pytest.approx(gain if criterion == "gain" else -1 / (s @ s + 1e-5), rel=1e-10)
