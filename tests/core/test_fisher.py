"""Fisher information: closed forms, reverse mode, NumPy, and the variance of estimates."""

from collections.abc import Iterator
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from jax.flatten_util import ravel_pytree

from hybrid_rl.core import adjoint, fisher
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.networks import mean_weights
from hybrid_rl.types import Path, Spec

T, N, M = 3, 2, 1
SIGMA = np.array([0.3, 0.7])
RNG = np.random.default_rng(0)
V = RNG.uniform(-1, 1, (T, M))
MODEL = Gaussian(hidden=(3,), activation="tanh", normalise=False)
along = jax.jit(fisher.along, static_argnums=(0, 3))


def policy(x: Array) -> Array:
    return jnp.tanh(x[:M])


@pytest.fixture(autouse=True)
def _double() -> Iterator[None]:
    """Float64, so that bounds can be close."""
    with jax.enable_x64(True):
        yield


def network(model: Gaussian = MODEL) -> tuple:
    """A step of (theta, x, u) and theta, in float64."""
    params = model.init(jax.random.key(1), Spec(N, M, 0.1))
    params = jax.tree.map(lambda x: jnp.asarray(x, jnp.float64), params)

    def step(theta, x: Array, u: Array) -> Array:
        return model.step(mean_weights.replaced(params, theta), x, u)

    return step, mean_weights.of(params)


@partial(jax.jit, static_argnums=0)
def rolled(step, theta, v) -> Path:
    return adjoint.roll(lambda x, u: step(theta, x, u), policy, jnp.array([0.4, -0.2]), v)


def test_information_of_a_linear_model_is_that_of_its_regression() -> None:
    """diag kron(1 / sigma^2, Z'Z), the rows of Z are (1, x, u): here [bias [n], kernel [., n]]."""
    step, theta = network(Gaussian(hidden=(), normalise=False))
    x, u = RNG.normal(size=(T + 1, N)), RNG.normal(size=(T, M))
    F = along(step, theta, Path(jnp.asarray(x), jnp.asarray(u)), "step")
    z = np.column_stack([np.ones(T), x[:-1], u])
    expected = np.kron((z**2).sum(0), 1 / SIGMA**2)
    np.testing.assert_allclose(fisher.diagonal(F, jnp.asarray(SIGMA)).sum(0), expected, rtol=1e-12)
    flat = np.asarray(F).reshape(-1, expected.size) / np.tile(SIGMA, T)[:, None]
    np.testing.assert_allclose(flat.T @ flat, np.kron(z.T @ z, np.diag(SIGMA**-2)), atol=1e-12)


def test_sensitivities_by_path_are_derivatives_of_the_rolled_out_states() -> None:
    """By forward mode through the whole path, with open-loop actions."""
    step, theta = network()
    path = rolled(step, theta, V)
    flat, unravel = ravel_pytree(theta)

    def states(flat: Array) -> Array:
        def forward(x: Array, u: Array) -> tuple[Array, Array]:
            return (step(unravel(flat), x, u),) * 2

        return jax.lax.scan(forward, path.x[0], path.u)[1]

    F = along(step, theta, path, "path")
    np.testing.assert_allclose(F, jax.jit(jax.jacfwd(states))(flat), atol=1e-13)


@pytest.mark.parametrize("kind", fisher.KINDS)
def test_products_are_those_of_the_derivatives(kind) -> None:
    step, theta = network()
    path, (flat, unravel) = rolled(step, theta, V), ravel_pytree(theta)
    v = jnp.asarray(RNG.normal(size=flat.size))
    F = along(step, theta, path, kind)
    products = jax.jit(fisher.products, static_argnums=(0, 3))
    product = products(step, theta, path, kind, unravel(v))
    np.testing.assert_allclose(product, F @ v, atol=1e-12)


@pytest.mark.parametrize("name", fisher.CRITERIA)
def test_criteria_are_those_of_numpy(name) -> None:
    """D, A and T of the diagonal; `full` is the determinant of the P x P matrix."""
    F, prior = RNG.normal(size=(T, N, 7)), RNG.uniform(0.1, 1.0, 7)
    each = np.stack([f.T @ np.diag(SIGMA**-2) @ f for f in F])
    known, total = np.diag(prior), each.sum(0) + np.diag(prior)
    diagonals = np.diagonal(each, axis1=1, axis2=2)
    expected = {
        "A_step": -(1 / (diagonals + prior[None])).sum(),
        "A": -(1 / np.diag(total)).sum(),
        "D": np.log(np.diag(total) / prior).sum(),
        "T": np.log(np.trace(total)),
        "full": np.linalg.slogdet(total)[1] - np.linalg.slogdet(known)[1],
    }
    criterion = jax.jit(fisher.criterion, static_argnums=0)
    value = criterion(name, jnp.asarray(F), jnp.asarray(SIGMA), jnp.asarray(prior))
    np.testing.assert_allclose(value, expected[name], rtol=1e-12)


def test_an_unstable_path_does_not_overflow() -> None:
    """x' = 1e4 x in float32: the derivative is cut, criteria and gradients stay finite."""
    x = jnp.ones((21, 1), jnp.float32)

    def total(u: Array) -> Array:
        path, one = Path(x, u), jnp.ones(1, jnp.float32)
        given = lambda a, x, u: 1e4 * a * x + u, one, path, "path"
        F = along(*given)
        each = [fisher.criterion(n, F, jnp.ones(1), jnp.ones(1)) for n in fisher.CRITERIA]
        return jnp.stack(each).sum() + jnp.sum(fisher.products(*given, one) ** 2)

    value, slope = jax.jit(jax.value_and_grad(total))(jnp.zeros((20, 1), jnp.float32))
    assert np.isfinite(value)
    assert np.isfinite(slope).all()
