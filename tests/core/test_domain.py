"""A box in some coordinates."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.core.domain import Box

BOX = Box(coordinates=(2, 0), low=(-1.0, 0.0), high=(1.0, 4.0))


def test_a_box_samples_points_and_selects_coordinates() -> None:
    """Uniform samples fill the box; coordinates are selected and replaced."""
    s = np.asarray(BOX.sample(20_000, jax.random.key(0)))
    np.testing.assert_allclose(s.mean(0), [0, 2], atol=0.05)
    np.testing.assert_allclose([s.min(0), s.max(0)], [BOX.low, BOX.high], atol=0.01)
    assert (BOX.volume, BOX.size) == (8, 2)
    x = jnp.array([[5.0, 6.0, 7.0], [8.0, 9.0, 10.0]])
    np.testing.assert_array_equal(BOX.of(x), [[7, 5], [10, 8]])
    np.testing.assert_array_equal(BOX.put(x[0], jnp.array([1.0, 2.0])), [2, 6, 1])


def test_points_of_a_lattice_are_uniform_each_and_even_together() -> None:
    """Over the shifts a point has the moments of a uniform one; one lattice fills all cells."""
    box = replace(BOX, lattice=True)
    each = jax.vmap(lambda key: box.sample(7, key))(jax.random.split(jax.random.key(0), 4000))
    unit = (np.asarray(each) - [-1, 0]) / [2, 4]
    np.testing.assert_allclose(unit.mean(0), 0.5, atol=0.02)
    np.testing.assert_allclose(unit.std(0), 12**-0.5, atol=0.01)
    s = (np.asarray(box.sample(400, jax.random.key(1))) - [-1, 0]) / [2, 4]
    counts = np.histogram2d(*s.T, bins=10, range=[[0, 1], [0, 1]])[0]
    assert 2 <= counts.min() <= counts.max() <= 6  # of 4 each; independent points miss cells


def test_distance_outside_is_squared_and_averaged() -> None:
    """0 inside, (1, 2) and (-2, 0) beyond sides of lengths 2 and 4."""
    s = jnp.array([[0.5, 1.0], [2.0, 6.0], [-3.0, 0.0]])
    assert float(BOX.outside(s)) == pytest.approx((0 + 0.25 + 0.25 + 1) / 3)
