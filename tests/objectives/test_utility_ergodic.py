"""The KL-ergodic measure of states and actions under a critic."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from scipy.stats import multivariate_normal

from hybrid_rl.core import ergodic, statistics
from hybrid_rl.objectives.utility_ergodic import UtilityErgodic
from hybrid_rl.types import Params, Path, Spec

SPEC = Spec(obs=2, act=1, dt=0.1)
UNITS = jnp.array([0.5, 4.0])
KNOWN = Params(model={"state": statistics.init(2).replace(std=UNITS)})
X = jnp.array([1.0, -2.0])


class Known:
    """pi = 0.9 and Q = 3 x_0 + u."""

    def mean(self, params: Any, x: Array) -> Array:
        return jnp.array([0.9])

    def value(self, params: Any, x: Array, u: Array) -> Array:
        return 3 * x[:, 0] + u[:, 0]


J = UtilityErgodic(None, Known(), Known(), samples=50, variance=0.2, reach=0.4, sharpness=2.0)


def points_of(value: Any, monkeypatch) -> Any:
    """The points that J passes to `ergodic.divergence`."""
    seen = []
    with monkeypatch.context() as patch:
        patch.setattr(ergodic, "divergence", lambda s, *_: seen.append(s) or jnp.zeros(()))
        value(Path(jnp.tile(X, (3, 1)), jnp.zeros((2, 1))))
    return seen[0]


def prepare() -> Any:
    """J of paths that begin at X."""
    return J.prepare(KNOWN, J.init(SPEC), X, jnp.zeros(1), jax.random.key(0))[0]


def test_points_lie_around_the_state_and_its_action(monkeypatch) -> None:
    """In running standard deviations, within the bounds of actions; weights are exp(c Q)."""
    points = points_of(prepare(), monkeypatch)
    apart = np.asarray(points.s) - np.array([1 / 0.5, -2 / 4, 0.9])
    assert np.abs(apart[:, :2]).max() == pytest.approx(0.4, abs=0.03)
    assert apart[:, 2].mean() == pytest.approx(-0.15, abs=0.05)  # between 0.5 and 1
    assert 0.97 < float(points.s[:, 2].max()) <= 1
    q = 3 * 0.5 * np.asarray(points.s[:, 0]) + np.asarray(points.s[:, 2])
    want = np.exp(2 * q) / np.exp(2 * q).sum()
    np.testing.assert_allclose(np.exp(points.log_p), want, rtol=1e-4)


def test_value_equals_a_plain_sum(monkeypatch) -> None:
    """A double loop with SciPy's Gaussians."""
    value = prepare()
    points = points_of(value, monkeypatch)
    rng = np.random.default_rng(0)
    x = jnp.asarray(np.asarray(X) + 0.2 * rng.normal(size=(4, 2)), jnp.float32)
    path = Path(x, jnp.array([[0.1], [0.5], [0.9]]))
    at = np.concatenate([np.asarray(path.x[:-1]) / np.asarray(UNITS), np.asarray(path.u)], 1)
    total = 0.0
    for s, log_p in zip(np.asarray(points.s), np.asarray(points.log_p), strict=True):
        q = np.mean([multivariate_normal.pdf(s, centre, 0.2 * np.eye(3)) for centre in at])
        total += np.exp(log_p) * (log_p + np.log(50) - np.log(q))
    assert float(value(path)) == pytest.approx(-total, rel=1e-4)
