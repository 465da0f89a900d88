"""Systematic resampling and circular means against counts and complex numbers."""

import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.core import resampling


def test_each_particle_is_drawn_in_proportion_to_its_weight() -> None:
    """Floor or ceiling of count times weight, and exactly that on average over the shifts."""
    rng = np.random.default_rng(0)
    w = rng.dirichlet(np.ones(20))
    shifts = (np.arange(400) + 0.5) / 400
    counts = np.stack(
        [
            np.bincount(resampling.systematic(jnp.log(w), 50, jnp.float32(shift)), minlength=20)
            for shift in shifts
        ]
    )
    assert (counts.sum(1) == 50).all()
    assert (counts >= np.floor(50 * w - 1e-4)).all()
    assert (counts <= np.ceil(50 * w + 1e-4)).all()
    np.testing.assert_allclose(counts.mean(0), 50 * w, atol=0.02)


def test_a_shift_near_one_stays_within_the_particles() -> None:
    """Rounding of the cumulative sum draws no particle of weight 0."""
    drawn = resampling.systematic(jnp.log(jnp.array([0.3, 0.7, 0.0])), 7, jnp.float32(0.9999999))
    assert int(drawn.max()) == 1


@pytest.mark.parametrize("w", [np.full(5, 0.2), np.eye(5)[2], np.array([0.5, 0.5, 0, 0, 0])])
def test_effective_number(w) -> None:
    with np.errstate(divide="ignore"):
        log_w = jnp.asarray(np.log(w) + 3.0)
    assert float(resampling.effective(log_w)) == pytest.approx(1 / (w**2).sum(), rel=1e-5)


def test_circular_mean_is_the_argument_of_the_mean_of_unit_numbers() -> None:
    rng = np.random.default_rng(1)
    angle, w = np.pi + 0.3 * rng.normal(size=30), rng.dirichlet(np.ones(30))
    mean = np.sum(w * np.exp(1j * angle))
    got = resampling.circular(jnp.asarray(angle), jnp.asarray(w))
    np.testing.assert_allclose(got, [np.angle(mean), np.abs(mean)], rtol=1e-5)
