"""Targets against SciPy and closed forms."""

from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest
from scipy.stats import multivariate_normal

from hybrid_rl.core.domain import Box
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.targets.mixture import Mixture
from hybrid_rl.targets.model_uncertainty import ModelUncertainty
from hybrid_rl.targets.upper_confidence_bound import UpperConfidenceBound
from hybrid_rl.types import Params


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
