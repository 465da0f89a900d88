"""The adjoint core against reverse mode and finite differences."""

from collections.abc import Iterator
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.core import adjoint, rollout
from hybrid_rl.types import Path

T = 6
X = np.array([0.8, -0.4])
roll = jax.jit(adjoint.roll, static_argnums=(0, 1))
gradients = jax.jit(adjoint.adjoint, static_argnums=(0, 1, 2))
insertion_gradient = jax.jit(adjoint.mode_insertion_gradient, static_argnums=(0, 1))
insertion_ahead = jax.jit(adjoint.insertion_ahead, static_argnums=(0, 1, 2, 5))


@pytest.fixture(autouse=True)
def _double() -> Iterator[None]:
    """Float64, so that bounds can be close."""
    with jax.enable_x64(True):
        yield


def bent(x: Array, u: Array) -> Array:
    """A nonlinear model."""
    return x + 0.1 * jnp.array([jnp.sin(x[1]) + u[0] ** 2, x[0] * u[0] + jnp.cos(x[0])])


def feedback(x: Array) -> Array:
    """A nonlinear policy."""
    return jnp.tanh(jnp.array([0.4 * x[0] - x[1] * x[0]]))


def staged(path: Path) -> Array:
    """A sum of rewards of states and actions."""
    return -jnp.sum(path.x**2) - 0.3 * jnp.sum(path.u**2 * path.x[:-1, :1])


def coupled(path: Path) -> Array:
    """An objective that couples all times."""
    apart = path.x[:, None] - path.x[None]
    return jax.nn.logsumexp(-jnp.sum(apart**2, -1)) + jnp.prod(1 + path.u)


@pytest.mark.parametrize("objective", [staged, coupled])
def test_gradient_is_reverse_mode(objective) -> None:
    """The gradient is dJ/dv, also for nonzero corrections and any functional of the path."""
    v = 0.3 * jnp.cos(jnp.arange(T, dtype=float))[:, None]

    def value(v: Array) -> Array:
        return objective(roll(bent, feedback, X, v))

    result = gradients(bent, feedback, objective, roll(bent, feedback, X, v))
    np.testing.assert_allclose(result.gradient, jax.jit(jax.grad(value))(v), rtol=0, atol=1e-13)


@pytest.mark.parametrize("objective", [staged, coupled])
@pytest.mark.parametrize("other", [-0.7, 0.2, 1.0])
def test_mode_insertion_gradient_is_the_derivative_of_a_short_switch(objective, other) -> None:
    """dJ/ds at s = 0, where the other action acts for a share s of the first decision."""
    u = jnp.array([other])
    path = roll(bent, feedback, X, jnp.zeros((T, 1)))
    result = gradients(bent, feedback, objective, path)

    def switched(s: float) -> float:
        x = jnp.asarray(X)
        after = x + (1 - s) * (bent(x, path.u[0]) - x) + s * (bent(x, u) - x)
        rest = roll(bent, feedback, after, jnp.zeros((T - 1, 1)))
        joined = Path(jnp.concatenate([x[None], rest.x]), jnp.concatenate([path.u[:1], rest.u]))
        jump = objective(path._replace(u=path.u.at[0].set(u))) - objective(path)
        return float(objective(joined) + s * jump)

    slope = (switched(1e-6) - switched(-1e-6)) / 2e-6
    got = insertion_gradient(bent, objective, result, u)
    assert float(got) == pytest.approx(slope, rel=1e-6)
    ahead = insertion_ahead(bent, feedback, objective, jnp.asarray(X), u, T)
    assert float(ahead) == pytest.approx(float(got), rel=1e-12)


def test_bound_clips_the_costate() -> None:
    """With a bound, rho is clipped, and g follows from the clipped rho."""
    path = roll(bent, feedback, X, jnp.zeros((T, 1)))
    free = gradients(bent, feedback, staged, path)
    result = gradients(bent, feedback, staged, path, bound=0.5)
    np.testing.assert_array_equal(result.costate, np.clip(free.costate, -0.5, 0.5))
    through = jax.vjp(bent, path.x[0], path.u[0])[1](result.costate[1])[1]
    last = jax.grad(staged)(path).u[0] + through
    np.testing.assert_allclose(result.gradient[0], last, rtol=0, atol=1e-13)


def test_the_mode_insertion_gradient_scales_with_the_variance_and_its_ratio_does_not() -> None:
    """For u = mu + Sigma g the insertion gradient is g' Sigma g to first order (Corollary 1)."""
    path = roll(bent, feedback, X, jnp.zeros((T, 1)))
    g = gradients(bent, feedback, staged, path).gradient[0]
    result = []
    for variance in (jnp.array([4e-4]), jnp.array([1e-4])):
        u = feedback(X) + variance * g
        insertion = insertion_ahead(bent, feedback, staged, X, u, T)
        result.append((insertion, adjoint.per_variance(insertion, variance)))
    (wide, of_wide), (narrow, of_narrow) = result
    assert float(wide / narrow) == pytest.approx(4, rel=1e-2)
    rates = [float(each["planner/insertion_per_variance"]) for each in (of_wide, of_narrow)]
    np.testing.assert_allclose(rates, float(g[0] ** 2), rtol=2e-2)
    of_two = adjoint.per_variance(jnp.float32(6.0), jnp.array([1.0, 2.0]))
    assert float(of_two["planner/policy_variance"]) == 3


def test_a_plan_moves_along_the_normalised_gradient_within_the_limits() -> None:
    """x' = x + u, r = x' - u^2 / 2: g_t = T - t - u_t, in falling steps, clipped at 1."""

    def reward(x: Array, u: Array, after: Array) -> Array:
        return (after - u**2 / 2).sum()

    plan = jax.jit(partial(adjoint.plan, lambda x, u: x + u, reward, iterations=2))
    before = np.array([[0.9], [-0.3], [0.2]])
    wanted = before
    for gain in (0.2, 0.1):
        g = np.array([[3.0], [2.0], [1.0]]) - wanted
        wanted = np.clip(wanted + gain * g / np.sqrt((g**2).mean()), -1, 1)
    assert wanted[0, 0] == 1
    np.testing.assert_allclose(plan(jnp.zeros(1), jnp.asarray(before)), wanted, rtol=1e-5)


def test_a_cpu_unrolls_few_steps() -> None:
    """There XLA would compute a coupled step again for every use of its result."""
    assert [rollout.scan_unroll(length) for length in (1, 4, 5, 32, 120)] == [1, 4, 4, 4, 4]
