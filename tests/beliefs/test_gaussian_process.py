"""The Gaussian process against its equations in NumPy."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.beliefs.gaussian_process import GaussianProcess
from hybrid_rl.types import Spec

GP = GaussianProcess(size=2, capacity=8, length=0.3, signal=0.7, noise=0.1)
SPEC = Spec(obs=2, act=1, dt=0.1)


def measured(count: int) -> tuple:
    """A belief after `count` measurements, and these."""
    rng = np.random.default_rng(0)
    s, y = rng.uniform(-1, 1, (count, 2)), rng.normal(size=count)
    state = GP.init(jax.random.key(0), SPEC)
    for at, value in zip(s, y, strict=True):
        state = GP.add(state, jnp.asarray(at), jnp.asarray(value), None)
    return state, s, y


def by_hand(s, y, at) -> tuple[float, float]:
    """Mean and standard deviation at `at` [2]."""

    def k(a, b):
        return 0.49 * np.exp(-((a[:, None] - b[None]) ** 2).sum(-1) / (2 * 0.09))

    K, c = k(s, s) + 0.01 * np.eye(len(s)), k(at[None], s)[0]
    return c @ np.linalg.solve(K, y), np.sqrt(0.49 - c @ np.linalg.solve(K, c))


@pytest.mark.parametrize("count", [0, 3, 8, 11])
def test_predictions_follow_the_equations(count) -> None:
    """With an empty, a partly filled and a full ring, and after the oldest are overwritten."""
    with jax.enable_x64(True):
        state, s, y = measured(count)
        at = np.array([0.1, -0.2])
        got, best = GP.predict(state, jnp.asarray(at)), GP.report(state)["belief/best"]
    s, y = s[-8:], y[-8:]
    np.testing.assert_allclose(got, by_hand(s, y, at) if count else (0.0, 0.7), atol=1e-9)
    if count:
        assert float(best) == pytest.approx(y.max())


def test_loss_is_the_negative_log_likelihood_of_the_next_measurement() -> None:
    """Its variance includes the noise of a measurement."""
    with jax.enable_x64(True):
        state, s, y = measured(5)
        at = np.array([0.3, 0.3])
        mean, std = by_hand(s, y, at)
        variance = std**2 + 0.01
        wanted = 0.5 * ((0.4 - mean) ** 2 / variance + np.log(2 * np.pi * variance))
        got = GP.loss(state, jnp.asarray(at), jnp.asarray(0.4))
        assert float(got) == pytest.approx(wanted, rel=1e-9)
