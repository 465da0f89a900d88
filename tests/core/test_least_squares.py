"""Recursive least squares against the closed form, and its precision in float32."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.core import least_squares

R, A, N = 7, 3, 60  # regressors, outputs, decisions
RNG = np.random.default_rng(0)
S, Y, MEAN = RNG.normal(size=(N, R)), RNG.normal(size=(N, A)), RNG.normal(size=(A, R))
PRIOR = 0.3


def recursive(forgetting: float, batch: int = 1) -> least_squares.Factor:
    """The factor after all rows, `batch` at a time, in float64."""

    def follow(factor: least_squares.Factor, row: tuple) -> tuple:
        return least_squares.add(factor, *row, jnp.asarray(MEAN), PRIOR, forgetting), None

    rows = (jnp.asarray(each.reshape(-1, batch, each.shape[1])) for each in (S, Y))
    factor = least_squares.begin(jnp.asarray(MEAN), PRIOR)
    return jax.lax.scan(follow, factor, tuple(rows))[0]


@pytest.mark.parametrize(("forgetting", "batch"), [(1.0, 1), (0.9, 1), (0.9, 4)])
def test_solution_is_weighted_least_squares(forgetting: float, batch: int) -> None:
    """The normal equations in NumPy, with a prior of full weight whatever was forgotten."""
    age = (N - 1 - np.arange(N)) // batch
    weighted = S * (forgetting ** (age[:, None]))
    information = weighted.T @ S + PRIOR * np.eye(R)
    expected = np.linalg.solve(information, weighted.T @ Y + PRIOR * MEAN.T).T
    with jax.enable_x64(True):
        factor = recursive(forgetting, batch)
        np.testing.assert_allclose(least_squares.solve(factor)[0], expected, atol=1e-12)
        np.testing.assert_allclose(factor.U.T @ factor.U, information, rtol=1e-12, atol=1e-12)
        np.testing.assert_array_equal(jnp.tril(factor.U, -1), 0)
        logs = np.linalg.slogdet(information)[1]
        assert float(least_squares.log_det(factor.U)) == pytest.approx(logs, rel=1e-12)
        s, spread = jnp.asarray(S[0]), least_squares.solve(factor)[1]
        quadratic = S[0] @ np.linalg.solve(information, S[0])
        assert float(least_squares.leverage(spread, s)) == pytest.approx(quadratic, rel=1e-12)


def test_directions_without_data_keep_the_prior() -> None:
    """After 2,000 decisions that excite one direction, with forgetting."""
    mean = jnp.array([[0.3, -0.8]])
    factor = least_squares.begin(mean, 1.0)
    row = jnp.array([[1.0, 0.0]]), jnp.array([[5.0]])

    @jax.jit
    def follow(factor: least_squares.Factor) -> least_squares.Factor:
        add = lambda _, f: least_squares.add(f, *row, mean, 1.0, 0.95)  # noqa: E731
        return jax.lax.fori_loop(0, 2000, add, factor)

    K = least_squares.solve(follow(factor))[0][0]
    np.testing.assert_allclose(K, [(5 * 20 + 0.3) / 21, -0.8], rtol=1e-4)


def test_float32_is_far_more_precise_than_with_sums() -> None:
    """Nearly collinear regressors, of condition number 3,000, against float64."""
    rng = np.random.default_rng(1)
    mix = np.linalg.qr(rng.normal(size=(R, R)))[0] * np.geomspace(1, 1 / 3000, R)
    s = rng.normal(size=(400, R)) @ mix.T
    y = s @ MEAN.T + 1e-3 * rng.normal(size=(400, A))
    exact = np.linalg.lstsq(np.vstack([s, 1e-4 * np.eye(R)]), np.vstack([y, np.zeros((R, A))]))[0]

    def follow(factor: least_squares.Factor, row: tuple) -> tuple:
        return least_squares.fold(factor, row[0][None], row[1][None]), None

    rows = jnp.asarray(s, jnp.float32), jnp.asarray(y, jnp.float32)
    begin = least_squares.begin(jnp.zeros((A, R)), 1e-8)
    root = least_squares.solve(jax.lax.scan(follow, begin, rows)[0])[0]
    sums = (rows[0].T @ rows[0] + 1e-8 * jnp.eye(R), rows[0].T @ rows[1])
    normal = jnp.linalg.solve(*sums).T
    errors = [float(np.abs(np.asarray(K).T - exact).max()) for K in (root, normal)]
    assert errors[0] < 0.01
    assert errors[0] < errors[1] / 20
