"""Small linear systems, alone and in batches."""

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.core.solving import log_det_one_plus, solve, solve_upper

RNG = np.random.default_rng(0)
A, B = RNG.normal(size=(3, 4, 6, 6)).astype(np.float32), RNG.normal(size=(6, 2)).astype(np.float32)


def test_batches_are_solved_as_single_systems() -> None:
    """Under two `vmap`s, with one right-hand side for all."""
    both = jax.vmap(jax.vmap(solve, (0, None)), (0, None))(jnp.asarray(A), jnp.asarray(B))
    np.testing.assert_allclose(A @ np.asarray(both), np.broadcast_to(B, (3, 4, 6, 2)), atol=1e-3)


def test_back_substitution_inverts_a_triangle() -> None:
    """Entries below the diagonal are not read."""
    U = np.triu(A[0, 0]) + 3 * np.eye(6, dtype=np.float32)
    X = solve_upper(jnp.asarray(U + np.tril(np.ones((6, 6), np.float32), -1)), jnp.asarray(B))
    np.testing.assert_allclose(U @ X, B, atol=1e-5)


def test_no_batched_routine_of_lapack_is_called_on_a_cpu() -> None:
    """Batched calls can deadlock, so the compiled program solves one system at a time."""
    text = jax.jit(jax.vmap(solve, (0, None))).lower(A[0], B).as_text()
    calls = [line for line in text.splitlines() if "lapack" in line]
    assert calls
    assert not [line for line in calls if "4x6x" in line]
    batched = jax.jit(jax.vmap(jnp.linalg.solve, (0, None))).lower(A[0], B).as_text()
    assert [line for line in batched.splitlines() if "lapack" in line and "4x6x" in line]


def test_log_determinant_and_its_slope_are_those_of_numpy() -> None:
    """log det(1 + G) and (1 + G)^-1 of singular G, side by side under `vmap`, in float64."""
    F = RNG.normal(size=(3, 6, 4))
    G = F @ F.swapaxes(1, 2)
    with jax.enable_x64(True):
        value, slope = jax.vmap(jax.value_and_grad(log_det_one_plus))(jnp.asarray(G))
        forward = jax.vmap(lambda G, D: jax.jvp(log_det_one_plus, (G,), (D,))[1])(G, 2 * G)
    inverse = np.linalg.inv(np.eye(6) + G)
    np.testing.assert_allclose(value, np.linalg.slogdet(np.eye(6) + G)[1], rtol=1e-12)
    np.testing.assert_allclose(slope, inverse, atol=1e-12)
    np.testing.assert_allclose(forward, np.einsum("sij,sij->s", inverse, 2 * G), rtol=1e-12)


def test_log_determinant_is_finite_where_float32_rounds() -> None:
    """Eigenvalues 2e10 and 0: no Cholesky factor, and a value within the rounding of G."""
    F = (RNG.normal(size=(20, 3)) * 3e4).astype(np.float32)
    G = jnp.asarray(F @ F.T)
    value, slope = jax.value_and_grad(log_det_one_plus)(G)
    exact = np.linalg.slogdet(np.eye(3) + F.T.astype(float) @ F)[1]
    assert np.isfinite(slope).all()
    assert exact - 1 < value < exact + 20 * np.log(1 + 1e-6 * float(G.max()))
    assert np.isnan(jnp.linalg.cholesky(jnp.eye(20) + G)).any()
