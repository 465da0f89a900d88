"""Small linear systems, alone and in batches."""

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.core.solving import solve, solve_upper

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
