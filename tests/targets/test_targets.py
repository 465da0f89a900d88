"""Targets against SciPy and closed forms."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.stats import multivariate_normal
from toys import begun

from hybrid_rl.core.domain import Box
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.learners.dagger import Labels, Queried
from hybrid_rl.policies.deterministic import Deterministic
from hybrid_rl.targets.mixture import Mixture
from hybrid_rl.targets.model_uncertainty import ModelUncertainty
from hybrid_rl.targets.policy_residual import PolicyResidual
from hybrid_rl.targets.upper_confidence_bound import UpperConfidenceBound
from hybrid_rl.types import Params, Spec


def test_the_mixture_equals_that_of_scipy() -> None:
    """Weights need not sum to one; the last entry of a mean is repeated."""
    target = Mixture(((0.1, 0.4), (-0.3, 0.2)), (0.2, 0.5), (1.0, 3.0))
    for size in (2, 3, 4):
        s = np.linspace(-0.2, 0.3, size)
        wanted = 0.0
        for w, mean, std in zip((0.25, 0.75), target.means, target.stds, strict=True):
            centre = [*mean, mean[-1], mean[-1]][:size]
            wanted += w * multivariate_normal.pdf(s, centre, std**2 * np.eye(size))
        got = target.log_density(Params(), jnp.asarray(s, jnp.float32))
        assert float(got) == pytest.approx(np.log(wanted), rel=1e-4)


@dataclass(frozen=True)
class Flat:
    """Mean 2, standard deviation 0.5."""

    def predict(self, known: Any, s: Any) -> tuple:
        """Constants."""
        return jnp.float32(2.0), jnp.float32(0.5)


def test_the_upper_confidence_bound_follows_its_equation() -> None:
    """c (mean + kappa std)."""
    target = UpperConfidenceBound(Flat(), kappa=3.0, sharpness=4.0)
    assert float(target.log_density(Params(), jnp.zeros(1))) == pytest.approx(4 * 3.5)


BOX = Box(coordinates=(12, 17), low=(-1.0, -1.0), high=(1.0, 1.0))


@dataclass(frozen=True)
class Tilted:
    """Standard deviations |x|."""

    def std(self, known: Any, x: Any) -> Any:
        """The entries' absolute values."""
        return jnp.abs(x)


def test_the_model_uncertainty_follows_its_equation() -> None:
    """c mean sigma at s, all else at hover, where the rotation matrix has three ones."""
    target = ModelUncertainty(Tilted(), QuadcopterSE3(), BOX, sharpness=4.0)
    got = target.log_density(Params(), jnp.array([-0.5, 2.0]))
    assert float(got) == pytest.approx(4 * (0.5 + 2.0 + 3) / 18)


RNG = np.random.default_rng(5)
X, KNOWN = RNG.normal(size=(30, 4)), RNG.normal(size=(10, 4))
SCALE = np.array([1.0, 2.0, 0.5, 1.5])
POLICY = Deterministic(hidden=())
WEIGHTS = begun(POLICY, Spec(obs=4, act=2, dt=0.1))
ACTION = RNG.uniform(-1, 1, (10, 2))


def believed(evidence: Any = None, count: int = 10, capacity: int = 16) -> Params:
    """Parameters after `count` labels in a ring of `capacity`."""
    obs, action = (
        jnp.zeros((capacity, each.shape[1])).at[:count].set(each[:count])
        for each in (KNOWN, ACTION)
    )
    labels = Labels(obs, action, jnp.int32(count))
    return Params(policy=WEIGHTS, labels=Queried(labels, jnp.asarray(SCALE), evidence))


def at(target: Any, params: Params) -> np.ndarray:
    """exp log p at the rows of X."""
    x = jnp.asarray(X, jnp.float32)
    return np.exp(np.asarray(jax.vmap(lambda x: target.log_density(params, x))(x), float))


def test_the_residual_is_that_of_kernel_regression() -> None:
    """Empty rows of the ring do not count."""
    got = at(PolicyResidual(POLICY, bandwidth=0.7), believed())
    away = ((X[:, None] - KNOWN[None]) / (0.7 * SCALE)) ** 2
    w = np.exp(-0.5 * away.sum(-1))
    u = (w @ ACTION) / w.sum(1, keepdims=True)
    layer = WEIGHTS["weights"]["Dense_0"]
    mean = np.tanh(X @ np.asarray(layer["kernel"], float))
    np.testing.assert_allclose(got, ((mean - u) ** 2).sum(1) + 1e-6, rtol=1e-3)


def test_a_residual_without_labels_is_finite() -> None:
    """And far from all labels the nearest one counts."""
    assert np.isfinite(at(PolicyResidual(POLICY), believed(count=0))).all()
    assert np.isfinite(at(PolicyResidual(POLICY, bandwidth=1e-3), believed())).all()
