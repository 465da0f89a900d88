"""The regulator."""

from dataclasses import replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.core import riccati
from hybrid_rl.envs.analytic.cart_double_pendulum import CartDoublePendulum
from hybrid_rl.envs.analytic.no_dynamics import NoDynamics
from hybrid_rl.envs.analytic.point_mass import PointMass
from hybrid_rl.policies.regulator import Regulator


def test_the_room_of_an_unstable_system_is_the_largest_safe_correction() -> None:
    """The worst course of corrections uses all of the action, and nothing more."""
    policy = Regulator(CartDoublePendulum())
    A, B = riccati.at_equilibrium(policy.world)
    K, room = policy.solve()[0], policy.room()
    assert room is not None
    e, answers = B, []
    for _ in range(3000):
        answers.append((K @ e).item())
        e = (A - B @ K) @ e
    worst = room.most * np.sign(answers[::-1])
    e = np.zeros((6, 1))
    for v in worst:
        e = (A - B @ K) @ e + B * v
    assert np.abs(K @ e).item() + room.most == pytest.approx(1, rel=1e-6)
    slowest = np.abs(np.linalg.eigvals(A - B @ K)).max()
    assert slowest**room.time == pytest.approx(np.exp(-1))


@pytest.mark.parametrize("world", [PointMass(), NoDynamics()])
def test_a_stable_system_needs_no_room(world: Any) -> None:
    """A point mass that the regulator lets go drifts, and no faster; without dynamics A is 0."""
    assert Regulator(world).room() is None


def test_cart_double_pendulum_has_the_poles_of_its_source() -> None:
    """Bogdanov 2004: +4.10 and +10.39 [1/s], and their mirror images."""
    A = riccati.at_equilibrium(CartDoublePendulum())[0]
    poles = np.sort(np.log(np.linalg.eigvals(A).real) / 0.01)
    np.testing.assert_allclose(poles, [-10.39, -4.10, 0, 0, 4.10, 10.39], atol=0.01)


def test_free_coordinates_minimise_the_lyapunov_function() -> None:
    """V without the cart's position is the minimum of V over a grid of positions."""
    counted = Regulator(CartDoublePendulum(), (5.0, 50.0, 50.0, 20.0, 700.0, 700.0), (1600.0,))
    free = replace(counted, free=(0,))
    x = np.array([0.5, 0.02, -0.03, 0.1, 0.2, -0.1])
    with jax.enable_x64(True):
        positions = np.tile(x, (4001, 1))
        positions[:, 0] = np.linspace(-2, 2, 4001)
        values = jax.vmap(counted.lyapunov)(positions)
        minimum = jax.vmap(free.lyapunov)(positions)
        np.testing.assert_allclose(minimum, values.min(), rtol=1e-4)


N, M = 6, 2
RNG = np.random.default_rng(0)
WEIGHTS = np.diag(np.arange(1.0, N + 1)), 0.5 * np.eye(M)
SYSTEM = (0.6 * RNG.normal(size=(N, N)), RNG.normal(size=(N, M)), *WEIGHTS)


@pytest.mark.parametrize("steps", [1, 2, 5, 8, 20, 100])
def test_doubling_is_the_recursion(steps: int) -> None:
    """P <- Q + A' P (A - B K), from 0, for any number of steps."""
    A, B, Q, R = SYSTEM
    P = np.zeros((N, N))
    for _ in range(steps):
        P = Q + A.T @ P @ (A - B @ np.linalg.solve(R + B.T @ P @ B, B.T @ P @ A))
    with jax.enable_x64(True):
        doubled = riccati.finite_horizon(*map(jnp.asarray, SYSTEM), steps)
    np.testing.assert_allclose(doubled, P, rtol=1e-8)


def test_a_long_horizon_is_the_algebraic_equation() -> None:
    """2^10 steps, against SciPy."""
    with jax.enable_x64(True):
        A, B, _, R = map(jnp.asarray, SYSTEM)
        P = riccati.finite_horizon(*map(jnp.asarray, SYSTEM), 1024)
        K = riccati.gain(A, B, P, R)
    for ours, its in zip((K, P), riccati.regulator(*SYSTEM), strict=True):
        np.testing.assert_allclose(ours, its, rtol=1e-6)


def test_a_mode_out_of_reach_has_a_finite_cost() -> None:
    """It grows by 1.1 a decision, where SciPy finds no stabilising solution."""
    A, B = np.diag([0.9, 1.1]), np.array([[1.0], [0.0]])
    with pytest.raises(np.linalg.LinAlgError):
        riccati.regulator(A, B, np.eye(2), np.eye(1))
    P = riccati.finite_horizon(*map(jnp.asarray, (A, B, np.eye(2), np.eye(1))), 16)
    assert P[1, 1] == pytest.approx(sum(1.1 ** (2 * t) for t in range(16)), rel=1e-5)
