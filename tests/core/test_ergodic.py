"""Cosines on a box."""

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.core import ergodic

LOW, HIGH = (-1.0, 0.0), (1.0, 0.5)


def test_features_are_orthonormal() -> None:
    """Integrals over the box, on a grid."""
    sides = [a + (b - a) * (np.arange(200) + 0.5) / 200 for a, b in zip(LOW, HIGH, strict=True)]
    s = np.stack(np.meshgrid(*sides, indexing="ij"), -1).reshape(-1, 2)
    f = np.asarray(ergodic.cosines(jnp.asarray(s), LOW, HIGH, 4), np.float64)
    np.testing.assert_allclose(f.T @ f * (2.0 * 0.5 / 200**2), np.eye(16), atol=1e-4)


def test_decay_follows_its_equation() -> None:
    """(1 + |k|^2)^(-3/2) in the order of the features."""
    got = ergodic.fourier_decay(2, 3)
    wanted = [(1 + a**2 + b**2) ** -1.5 for a in range(3) for b in range(3)]
    np.testing.assert_allclose(got, wanted, rtol=1e-6)


def test_slopes_of_the_features_vanish_at_the_walls() -> None:
    """So that nothing leads out of the box."""
    slope = jax.jacfwd(lambda x: ergodic.cosines(x[None], LOW, HIGH, 4)[0])
    np.testing.assert_allclose(slope(jnp.array(HIGH)), 0, atol=1e-4)
