"""Cosines on a box."""

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.core import fourier
from hybrid_rl.core.domain import Box

LOW, HIGH = (-1.0, 0.0), (1.0, 0.5)


def test_features_are_orthonormal() -> None:
    """Integrals over the box, on a grid."""
    sides = [a + (b - a) * (np.arange(200) + 0.5) / 200 for a, b in zip(LOW, HIGH, strict=True)]
    s = np.stack(np.meshgrid(*sides, indexing="ij"), -1).reshape(-1, 2)
    f = np.asarray(fourier.features(jnp.asarray(s), LOW, HIGH, 4), np.float64)
    np.testing.assert_allclose(f.T @ f * (2.0 * 0.5 / 200**2), np.eye(16), atol=1e-4)


def test_decay_follows_its_equation() -> None:
    """(1 + |k|^2)^(-3/2) in the order of the features."""
    got = fourier.decay(2, 3)
    wanted = [(1 + a**2 + b**2) ** -1.5 for a in range(3) for b in range(3)]
    np.testing.assert_allclose(got, wanted, rtol=1e-6)


def test_slopes_of_the_features_vanish_at_the_walls() -> None:
    """So that nothing leads out of the box."""
    slope = jax.jacfwd(lambda x: fourier.features(x[None], LOW, HIGH, 4)[0])
    np.testing.assert_allclose(slope(jnp.array(HIGH)), 0, atol=1e-4)


def test_a_lattice_estimates_the_coefficients_of_a_ring_better_than_independent_points() -> None:
    """Against a quadrature of 400 x 400 cells; E is averaged over ten draws."""
    ends = (0.0, 0.0), (1.0, 1.0)

    def log_ring(s):
        return -0.5 * ((jnp.hypot(s[:, 0] - 0.5, s[:, 1] - 0.4) - 0.25) / 0.02) ** 2

    def coefficients(s):
        return jax.nn.softmax(log_ring(s)) @ fourier.features(s, *ends, 8)

    side = (np.arange(400) + 0.5) / 400
    exact = jax.jit(coefficients)(jnp.asarray(np.stack(np.meshgrid(side, side), -1).reshape(-1, 2)))
    errors = {}
    for lattice in (False, True):
        box, weights = Box((0, 1), *ends, lattice), fourier.decay(2, 8)

        def error(key, box=box, weights=weights):
            return fourier.metric(coefficients(box.sample(1000, key)), exact, weights)

        errors[lattice] = np.mean(jax.jit(jax.vmap(error))(jax.random.split(jax.random.key(0), 10)))
    assert errors[True] < errors[False] / 10
