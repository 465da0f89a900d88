"""The adjoint core against reverse mode, finite differences and the linear-quadratic optimum."""

from collections.abc import Iterator

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from scipy.linalg import solve_discrete_are

from hybrid_rl.core import adjoint
from hybrid_rl.types import Path

T = 6
A = np.array([[1.0, 0.1], [-0.2, 0.9]])
B = np.array([[0.0], [0.5]])
Q, R = np.diag([2.0, 0.3]), np.array([[0.7]])
X = np.array([0.8, -0.4])


@pytest.fixture(autouse=True)
def _double() -> Iterator[None]:
    """Float64, so that bounds can be close."""
    with jax.enable_x64(True):
        yield


def bent(x: Array, u: Array) -> Array:
    """A model that is linear in nothing."""
    return x + 0.1 * jnp.array([jnp.sin(x[1]) + u[0] ** 2, x[0] * u[0] + jnp.cos(x[0])])


def feedback(x: Array) -> Array:
    """A policy that is not linear either."""
    return jnp.tanh(jnp.array([0.4 * x[0] - x[1] * x[0]]))


def staged(path: Path) -> Array:
    """A sum of rewards of states and actions."""
    return -jnp.sum(path.x**2) - 0.3 * jnp.sum(path.u**2 * path.x[:-1, :1])


def coupled(path: Path) -> Array:
    """No sum over time: all times at once."""
    apart = path.x[:, None] - path.x[None]
    return jax.nn.logsumexp(-jnp.sum(apart**2, -1)) + jnp.prod(1 + path.u)


@pytest.mark.parametrize("objective", [staged, coupled])
def test_gradient_is_reverse_mode(objective) -> None:
    """G is dJ/dv, also at corrections that are not zero, for any functional of the path."""
    v = 0.3 * jnp.cos(jnp.arange(T, dtype=float))[:, None]

    def value(v: Array) -> Array:
        return objective(adjoint.roll(bent, feedback, X, v))

    found = adjoint.adjoint(bent, feedback, objective, adjoint.roll(bent, feedback, X, v))
    np.testing.assert_allclose(found.gradient, jax.grad(value)(v), rtol=0, atol=1e-13)


@pytest.mark.parametrize("objective", [staged, coupled])
def test_costate_is_the_answer_to_the_first_state(objective) -> None:
    """rho_0 is dJ/dx_0 under the policy, by central differences."""
    v = jnp.zeros((T, 1))
    found = adjoint.adjoint(bent, feedback, objective, adjoint.roll(bent, feedback, X, v))
    for i, e in enumerate(1e-6 * np.eye(2)):
        up, down = (objective(adjoint.roll(bent, feedback, X + s * e, v)) for s in (1, -1))
        assert float(found.costate[0, i]) == pytest.approx(float(up - down) / 2e-6, rel=1e-6)


def test_linear_quadratic_optimum() -> None:
    """Under the regulator of Riccati's equation rho = -P x, and nothing is left to correct."""
    p = solve_discrete_are(A, B, Q, R)
    gain = np.linalg.solve(R + B.T @ p @ B, B.T @ p @ A)

    def value(path: Path) -> Array:
        cost = jnp.einsum("ti,ij,tj", path.x[:-1], Q, path.x[:-1])
        cost += jnp.einsum("ti,ij,tj", path.u, R, path.u) + path.x[-1] @ p @ path.x[-1]
        return -0.5 * cost

    def regulator(x: Array) -> Array:
        return -gain @ x

    def step(x: Array, u: Array) -> Array:
        return A @ x + B @ u

    path = adjoint.roll(step, regulator, X, jnp.zeros((T, 1)))
    found = adjoint.adjoint(step, regulator, value, path)
    np.testing.assert_allclose(found.costate, -path.x @ p, rtol=0, atol=1e-13)
    np.testing.assert_allclose(found.gradient, 0, rtol=0, atol=1e-13)
    astray = adjoint.roll(step, regulator, X, 0.1 + 0 * path.u)
    off = adjoint.adjoint(step, regulator, value, astray)
    assert float(off.gradient[0, 0]) < -1e-3  # back to the optimum


@pytest.mark.parametrize("objective", [staged, coupled])
@pytest.mark.parametrize("other", [-0.7, 0.2, 1.0])
def test_mode_insertion_gradient_is_the_answer_to_a_short_switch(objective, other) -> None:
    """For a share s of the first decision the other action acts: d J / d s at s = 0."""
    u = jnp.array([other])
    path = adjoint.roll(bent, feedback, X, jnp.zeros((T, 1)))
    found = adjoint.adjoint(bent, feedback, objective, path)

    def switched(s: float) -> float:
        x = jnp.asarray(X)
        after = x + (1 - s) * (bent(x, path.u[0]) - x) + s * (bent(x, u) - x)
        rest = adjoint.roll(bent, feedback, after, jnp.zeros((T - 1, 1)))
        joined = Path(jnp.concatenate([x[None], rest.x]), jnp.concatenate([path.u[:1], rest.u]))
        jump = objective(path._replace(u=path.u.at[0].set(u))) - objective(path)
        return float(objective(joined) + s * jump)

    slope = (switched(1e-6) - switched(-1e-6)) / 2e-6
    got = adjoint.mode_insertion_gradient(bent, objective, found, u)
    assert float(got) == pytest.approx(slope, rel=1e-6)
    ahead = adjoint.insertion_ahead(bent, feedback, objective, jnp.asarray(X), u, T)
    assert float(ahead) == pytest.approx(float(got), rel=1e-12)


def test_insertion_into_a_single_decision() -> None:
    """T = 1: J after the switch less J before, where J is linear in the state."""

    def linear(path: Path) -> Array:
        return path.x[-1] @ jnp.array([2.0, -1.0]) + 0.5 * path.u[0, 0] ** 3

    x, u = jnp.asarray(X), jnp.array([0.9])
    one, other = (Path(jnp.stack([x, bent(x, v)]), v[None]) for v in (feedback(x), u))
    got = adjoint.insertion_ahead(bent, feedback, linear, x, u, 1)
    assert float(got) == pytest.approx(float(linear(other) - linear(one)), rel=1e-12)


def test_no_insertion_where_both_agree() -> None:
    """The policy's own action inserts nothing."""
    path = adjoint.roll(bent, feedback, X, jnp.zeros((T, 1)))
    found = adjoint.adjoint(bent, feedback, staged, path)
    assert float(adjoint.mode_insertion_gradient(bent, staged, found, path.u[0])) == 0


def test_bound_clips_the_costate() -> None:
    """With a bound, rho and only then g."""
    path = adjoint.roll(bent, feedback, X, jnp.zeros((T, 1)))
    free = adjoint.adjoint(bent, feedback, staged, path)
    found = adjoint.adjoint(bent, feedback, staged, path, bound=0.5)
    np.testing.assert_array_equal(found.costate, np.clip(free.costate, -0.5, 0.5))
    last = jax.grad(staged)(path).u[0] + jax.vjp(bent, path.x[0], path.u[0])[1](found.costate[1])[1]
    np.testing.assert_allclose(found.gradient[0], last, rtol=0, atol=1e-13)


def test_the_agreement_signal_falls_with_the_variance_and_its_rate_does_not() -> None:
    """Of u = mu + Sigma g the insertion gradient is g' Sigma g to first order (Corollary 1)."""
    path = adjoint.roll(bent, feedback, X, jnp.zeros((T, 1)))
    g = adjoint.adjoint(bent, feedback, staged, path).gradient[0]
    found = []
    for variance in (jnp.array([4e-4]), jnp.array([1e-4])):
        u = feedback(X) + variance * g
        insertion = adjoint.insertion_ahead(bent, feedback, staged, X, u, T)
        found.append((insertion, adjoint.per_variance(insertion, variance)))
    (wide, of_wide), (narrow, of_narrow) = found
    assert float(wide / narrow) == pytest.approx(4, rel=1e-2)
    rates = [float(each["planner/insertion_per_variance"]) for each in (of_wide, of_narrow)]
    np.testing.assert_allclose(rates, float(g[0] ** 2), rtol=2e-2)
    assert float(of_narrow["planner/policy_variance"]) == pytest.approx(1e-4)
