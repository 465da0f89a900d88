"""The study of Koopman operators: regulators of Van der Pol's oscillator."""

from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.linalg import solve_discrete_are
from studied import drawn

from hybrid_rl.features.monomials import Monomials
from hybrid_rl.learners.least_squares import LeastSquares
from hybrid_rl.learners.regulator import RegulatorLearner
from hybrid_rl.models.koopman import Koopman
from hybrid_rl.policies.linear import Linear
from hybrid_rl.settings import build as config
from hybrid_rl.thesis.studies import optimal_path, oscillator
from hybrid_rl.types import Spec

A = np.array([[1.0, 0.1], [-0.1, 1.1]])  # an unstable spiral
B = np.array([[0.0], [0.2]])


def test_three_regulators_are_one_on_a_linear_world() -> None:
    """Koopman, known and regression have the gain of SciPy's Riccati solution."""
    spec, rng = Spec(2, 1, 0.1), np.random.default_rng(0)
    model = Koopman(Monomials())
    x, u = rng.uniform(-1, 1, (200, 2)), rng.uniform(-1, 1, (200, 1))
    after = x @ A.T + u @ B.T
    learner = LeastSquares(model, prior=1e-6)
    x, u, after = (jnp.asarray(each, jnp.float32) for each in (x, u, after))
    params = oscillator.fit(learner, spec, x, u, after, jax.random.key(0))
    np.testing.assert_allclose(params["K"], np.hstack([A, B]), atol=1e-5)
    world: Any = SimpleNamespace(equilibrium=lambda: (jnp.zeros(2), jnp.zeros(1)))
    solver = RegulatorLearner(model, Linear(), world, (1.0, 2.0), (0.5,), 256)
    F = oscillator.gains(solver, (A, B), spec, params)
    P = solve_discrete_are(A, B, np.diag([1.0, 2.0]), np.diag([0.5]))
    right = np.linalg.solve(0.5 + B.T @ P @ B, B.T @ P @ A)[0]
    for each in F:
        np.testing.assert_allclose(each, right, rtol=1e-4)


def test_a_fit_is_numpys_least_squares() -> None:
    """On samples of Van der Pol's oscillator, in the thesis' functions."""
    run = config.build(config.load(["experiment=thesis/fig_7_1"]))
    K = np.asarray(oscillator.fits(run, 300, 2, 2.5)["K"])
    assert np.abs(K[0] - K[1]).max() > 1e-5
    world, key = run.agent.episode.env, jax.random.split(jax.random.key(1), 3)
    x = jax.random.uniform(key[1], (300, 2), minval=-2.5, maxval=2.5)
    u = jax.random.uniform(key[2], (300, 1), minval=-1.0) * 0.25  # |u| up to 5 of 20
    after = np.asarray(jax.vmap(world.dynamics)(x, u), float)

    def z(x: np.ndarray) -> np.ndarray:
        return np.stack([x[:, 0], x[:, 1], x[:, 0] ** 2, x[:, 1] * x[:, 0] ** 2], 1)

    s = np.hstack([z(np.asarray(x, float)), np.asarray(u, float)])
    right = np.linalg.lstsq(s, z(after), rcond=None)[0].T
    np.testing.assert_allclose(K[1], right, atol=1e-4)


def test_the_optimal_path_of_a_linear_system_costs_as_riccati() -> None:
    """From the Riccati equation, over a horizon after which nothing is left to pay."""
    Q, R = np.diag([1.0, 2.0]), np.diag([0.5])
    P = solve_discrete_are(A, B, Q, R)
    x = jnp.array([1.0, -0.5])
    f = [jnp.asarray(each, jnp.float32) for each in (A, B, Q, R)]
    path = optimal_path.optimal(
        lambda x, u: f[0] @ x + f[1] @ u, f[2], f[3], x, jnp.zeros((80, 1)), 2
    )
    paid = optimal_path.cost(path, f[2], f[3])
    # The first state is not counted
    np.testing.assert_allclose(paid, float(x @ (P - Q) @ x), rtol=1e-4)


def test_the_optimal_path_is_a_minimum_of_a_nonlinear_system() -> None:
    """A swing with x'' = sin x + u: no change of the actions costs less."""

    def step(x, u):
        rate = jnp.array([x[1], jnp.sin(x[0]) + u[0]])
        return x + 0.1 * rate

    Q, R, x = jnp.eye(2), jnp.eye(1), jnp.array([2.0, 0.0])
    path = optimal_path.optimal(step, Q, R, x, jnp.zeros((40, 1)))

    def paid(u):
        def forward(x, u):
            after = step(x, u)
            return after, after @ Q @ after + u @ R @ u

        return jax.lax.scan(forward, x, u)[1].sum()

    np.testing.assert_allclose(paid(path.u), optimal_path.cost(path, Q, R), rtol=1e-5)
    assert np.abs(jax.grad(paid)(path.u)).max() < 1e-3
    for _ in range(5):
        change = np.random.default_rng(0).normal(size=(40, 1)).astype(np.float32)
        assert paid(path.u + 0.1 * change) > paid(path.u)


def test_ratios_are_of_means_over_starts() -> None:
    """One draw, two starts; the Koopman operator costs half and is better from one start."""
    cost: Any = np.ones((1, 4, 3, 2))
    cost[:, :, 1], cost[:, :, 0] = (2, 4), (3, 0)
    outcome = oscillator.Outcome(cost, 2 * cost, 0 * cost)
    one = oscillator.reported(outcome, np.array([1.0, 1.0]))["50"]
    assert one["Koopman"]["cost"] == [0.5]
    assert one["Koopman"]["less_cost"] == [1]
    assert one["cost_of_known"] == 3
    assert one["optimum"] == pytest.approx(1 / 3)


def test_the_view_of_control_writes_its_numbers(tmp_path, monkeypatch) -> None:
    """With few samples and short paths; u is clipped nowhere."""
    monkeypatch.setattr(oscillator, "RANGES", (oscillator.INSIDE,))
    monkeypatch.setattr(oscillator, "STEPS", 60)
    monkeypatch.setattr(oscillator, "HORIZONS", (50, 100))
    given = ("view=control", "samples=200", "draws=2", "starts=3")
    numbers = drawn(tmp_path / "f.png", "koopman", *given)
    each = numbers["by_data"]["2.5, starts 2"]
    assert set(each) == {"50", "100"}
    for one in each.values():
        assert len(one["Koopman"]["cost"]) == 2
        assert 0 < one["optimum"] <= min(1, *one["Koopman"]["cost"])
    assert np.shape(numbers["rates_of_A"]["2.5, starts 2"]["real"]) == (2, 4)
