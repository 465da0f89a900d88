"""Koopman models, their regression and its information, against closed forms."""

import pathlib
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.linalg import expm

from hybrid_rl.core import adjoint
from hybrid_rl.features.monomials import Monomials
from hybrid_rl.learners.least_squares import LeastSquares
from hybrid_rl.models.koopman import Koopman
from hybrid_rl.objectives.information import Information
from hybrid_rl.types import Batch, Params, Path, Spec

pytestmark = pytest.mark.turns(2)

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


def test_predictions_stay_within_the_bound() -> None:
    """Also those of a K that explodes, many decisions ahead."""
    model = Koopman(Monomials(), bound=50.0)
    params = {**model.init(jax.random.key(0), SPEC), "K": 9.0 * jnp.ones((2, 3))}
    x = jnp.ones(2)
    for _ in range(20):
        x = model.step(params, x, jnp.ones(1))
    np.testing.assert_array_equal(x, 50.0)


def test_products_make_the_model_bilinear() -> None:
    """s = (x, u, x_1 u); K of the bilinear system is recovered."""
    model = Koopman(Monomials(), products=(1,))
    truth = RNG.normal(size=(2, 4))
    x, u = RNG.normal(size=(50, 2)), RNG.normal(size=(50, 1))
    after = np.column_stack([x, u, x[:, 1:] * u]) @ truth.T
    with jax.enable_x64(True):
        learner = LeastSquares(model, prior=1e-12)
        state = learner.init(jax.random.key(0), SPEC)
        state, _ = jax.jit(learner.update)(state, Params(), batch(x, u, after), jax.random.key(0))
        np.testing.assert_allclose(state.model["K"], truth, atol=1e-9)


def informed(criterion: str) -> tuple[Information, Params, Path]:
    """An objective, a model with some data, and a path."""
    with jax.enable_x64(True):
        model = Koopman(Monomials(terms=((0, 1),)), products=(0,))
        params = model.init(jax.random.key(0), SPEC)
        root = np.linalg.qr(RNG.normal(size=(9, 5)))[1] + 2 * np.eye(5)
        params = {
            **params,
            "K": jnp.asarray(RNG.normal(size=(3, 5))),
            "spread": jnp.asarray(np.linalg.inv(root)),
        }
        path = Path(jnp.asarray(RNG.normal(size=(7, 3))), jnp.asarray(RNG.normal(size=(6, 1))))
        return Information(model, criterion), Params(model=params), path


def test_gain_is_the_growth_of_the_information_of_the_regression() -> None:
    """log det (U'U + s s' / sigma^2) - log det U'U."""
    objective, params, path = informed("gain")
    U = np.linalg.inv(np.asarray(params.model["spread"]))
    with jax.enable_x64(True):
        got = objective.rewards(params, path)
        np.testing.assert_allclose(
            objective.reward_to_go(params, path), [*np.cumsum(got[::-1])[::-1], 0], rtol=1e-12
        )
        for t, r in enumerate(got):
            x, u = path.x[t], path.u[t]
            s = np.concatenate([x, u, x[0] * u])
            more = U.T @ U + np.outer(s, s) / 0.1**2
            expected = np.linalg.slogdet(more)[1] - np.linalg.slogdet(U.T @ U)[1]
            assert float(r) == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("criterion", ["gain", "norm"])
def test_the_gradient_of_information_is_that_of_central_differences(criterion: str) -> None:
    """In every entry of the path, in float64; and the adjoint's is that of reverse mode."""
    objective, params, path = informed(criterion)
    with jax.enable_x64(True):
        value, _ = objective.prepare(params, (), path.x[0], path.u[0], jax.random.key(0))
        gradient, value = jax.jit(jax.grad(value))(path), jax.jit(value)
        for name in ("x", "u"):
            field = getattr(path, name)
            for at in np.ndindex(field.shape):
                up, down = (
                    value(path._replace(**{name: field.at[at].add(e)})) for e in (1e-6, -1e-6)
                )
                difference = float(up - down) / 2e-6
                assert float(getattr(gradient, name)[at]) == pytest.approx(difference, abs=1e-7)
        step = lambda x, u: objective.model.step(params.model, x, u)  # noqa: E731
        policy = lambda x: jnp.clip(-0.4 * x[:1], -1, 1)  # noqa: E731
        x0, v = 0.1 * path.x[0], 0.05 * path.u
        along = adjoint.adjoint(step, policy, value, adjoint.roll(step, policy, x0, v))
        reverse = jax.grad(lambda v: value(adjoint.roll(step, policy, x0, v)))(v)
        np.testing.assert_allclose(along.gradient, reverse, rtol=1e-10, atol=1e-12)


def test_draws_of_the_model_have_the_covariance_of_the_regression() -> None:
    """noise^2 (U'U)^-1 for each row of K, around its mean."""
    _, params, _ = informed("gain")
    model = Koopman(Monomials(terms=((0, 1),)), products=(0,))
    params = jax.tree.map(lambda x: jnp.asarray(np.asarray(x), jnp.float32), params)
    draws = jax.vmap(lambda key: model.draw_model(params.model, 0.5, key)["K"])(
        jax.random.split(jax.random.key(0), 20000)
    )
    U = np.linalg.inv(np.asarray(params.model["spread"]))
    covariance = 0.25 * np.linalg.inv(U.T @ U)
    error = 5 * np.sqrt(np.diag(covariance) / len(draws))  # of the mean, five deviations
    assert (np.abs(draws.mean(0) - params.model["K"]) < error[None]).all()
    scale = np.sqrt(np.outer(np.diag(covariance), np.diag(covariance)))
    for row in range(3):
        difference = np.cov(np.asarray(draws[:, row]).T) - covariance
        np.testing.assert_allclose(difference / scale, 0, atol=0.05)
