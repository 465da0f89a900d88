"""The function that is measured without dynamics."""

import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.envs.analytic.state import phi


def test_the_highest_hill_of_three_is_one() -> None:
    x = np.linspace(-1, 1, 2001)
    y = np.asarray(phi(jnp.asarray(x)))
    assert x[y.argmax()] == pytest.approx(0.65)
    assert y.max() == pytest.approx(1.0, abs=1e-5)
    assert np.sum((y[1:-1] > y[:-2]) & (y[1:-1] > y[2:])) == 3
