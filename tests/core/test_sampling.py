"""The sampling core against a plain loop and its equations."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.core import sampling

K, T, N, M = 7, 4, 3, 2
A = jnp.array([[0.9, 0.1, 0.0], [0.0, 0.8, 0.2], [0.1, 0.0, 0.7]])
B = jnp.array([[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]])


def step(x: Array, u: Array) -> Array:
    """A linear model."""
    return A @ x + B @ u


def propose(carry: Array, x: Array, a: Array, noise: Array) -> tuple[Array, Array, Array]:
    """Noise around plan and state; the carry counts decisions."""
    v = a + 0.1 * x[:M] + noise
    return v, v.sum() + carry, carry + 1


def test_imagine_equals_a_plain_loop() -> None:
    """With equal noise, every path equals that of a Python loop."""
    x, plan = jnp.array([0.3, -0.2, 0.5]), jnp.arange(8.0).reshape(T, M) / 10
    noise = jax.random.normal(jax.random.key(3), (K, T, M))
    each = jax.vmap(propose, (0, 0, None, 0))
    got = sampling.imagine(step, each, jnp.zeros(K), jnp.tile(x, (K, 1)), plan, noise)
    for k in range(K):
        state, carry = x, jnp.float32(0)
        for t in range(T):
            v, log_prob, carry = propose(carry, state, plan[t], noise[k, t])
            state = step(state, v)
            np.testing.assert_allclose(got.path.u[k, t], v, rtol=1e-5, atol=1e-6)
            np.testing.assert_allclose(got.path.x[k, t + 1], state, rtol=1e-5, atol=1e-6)
            np.testing.assert_allclose(got.log_prob[k, t], log_prob, rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("shifted", [0.0, 1e4])
def test_weights_follow_their_equation(shifted: float) -> None:
    """exp(S / lambda) over its sum, also with a constant added to S."""
    s = np.random.default_rng(0).normal(size=(K, T))
    got = sampling.weights(jnp.float32(s + shifted), 0.5)
    want = np.exp(s / 0.5) / np.exp(s / 0.5).sum(0)
    np.testing.assert_allclose(got, want, rtol=5e-3 if shifted else 1e-5)


@pytest.mark.parametrize(("temperature", "normalise"), [(1e-6, False), (0.3, True)])
def test_equal_returns_have_equal_weights(temperature: float, normalise: bool) -> None:
    """However large the returns are, also compiled, where S / lambda may round in two ways."""
    weigh = jax.jit(lambda s: sampling.weights(s, temperature, normalise))
    s = np.geomspace(1, 1e8, 500)
    for returns in (s, -s):
        got = weigh(jnp.broadcast_to(jnp.float32(returns), (K, 500)))
        np.testing.assert_allclose(got, 1 / K, rtol=1e-6)


def test_weights_with_density_and_normalisation() -> None:
    """The density is added to the exponent; normalised returns have a standard deviation of 1."""
    rng = np.random.default_rng(1)
    s, log_prob = rng.normal(size=(K, T)), rng.normal(size=(K, T))
    got = sampling.weights(jnp.float32(100 * s), 2.0, True, jnp.float32(log_prob))
    raw = np.exp(s / s.std(0) / 2.0) * np.exp(log_prob)
    np.testing.assert_allclose(got, raw / raw.sum(0), rtol=1e-3)


def test_a_candidate_without_a_finite_return_has_no_weight() -> None:
    """The best action that is allowed lies at 0.3; where none is, the plan is NaN."""
    x, before, key = jnp.zeros(1), jnp.zeros((1, 1)), jax.random.key(0)

    def plan(bad: float) -> Array:
        def reward(x: Array, u: Array, after: Array) -> Array:
            return jnp.where(after[0] > 0.3, bad, u[0])

        return sampling.plan(lambda x, u: x + u, reward, x, before, key)

    assert plan(1.0) > 0.4
    assert 0.2 < plan(-jnp.inf) <= 0.3
    assert plan(jnp.nan) == plan(-jnp.inf)
    always = sampling.plan(lambda x, u: x * jnp.nan, lambda x, u, after: after[0], x, before, key)
    assert np.isnan(always).all()


def test_a_plan_moves_by_the_deviation_divided_by_the_temperature() -> None:
    """For r = u: S_1 = u_1 is alone in its deviation, S_0 = u_0 + u_1 shares it with u_1."""
    x, before = jnp.zeros(1), jnp.array([[0.3], [-0.2]])
    given: dict = {"samples": 20_000, "std": 0.1, "temperature": 2.0}
    make = jax.jit(partial(sampling.plan, lambda x, u: x, lambda x, u, after: u[0], **given))
    moved = make(x, before, jax.random.key(0)) - before
    np.testing.assert_allclose(moved[:, 0], [0.05 / np.sqrt(2), 0.05], atol=0.003)
    assert (make(x, jnp.ones((2, 1)), jax.random.key(0)) < 1).all()  # whose candidates are clipped
