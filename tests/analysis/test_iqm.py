"""The interquartile mean over seeds and its bootstrap band."""

import numpy as np
import pytest
from scipy.stats import trim_mean

from hybrid_rl.analysis.curves import band, iqm
from hybrid_rl.analysis.learning_curves import FEW


@pytest.mark.parametrize("n", [4, 8, 20])
def test_iqm_is_the_trimmed_mean_where_quarters_are_whole(n):
    values = np.random.default_rng(0).normal(size=(n, 3))
    np.testing.assert_allclose(iqm(values), trim_mean(values, 0.25, axis=0), rtol=1e-12)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([7], 7),
        ([1, 2], 1.5),
        ([0, 1, 5], (0.25 * 0 + 1 + 0.25 * 5) / 1.5),
        ([100, 2, 1, 3, -100], (0.75 * 1 + 2 + 0.75 * 3) / 2.5),
        ([8, 1, 2, 3, 4, 100], (0.5 * 2 + 3 + 4 + 0.5 * 8) / 3),
    ],
)
def test_iqm_of_few_seeds_weighs_the_border(values, expected):
    assert iqm(np.array(values, float)) == pytest.approx(expected, rel=1e-12)


def test_the_band_of_few_seeds_is_their_range():
    for seeds in range(2, FEW + 1):
        np.testing.assert_allclose(band(np.arange(seeds * 1.0)), [0, seeds - 1])
    assert band(np.arange(FEW + 1.0))[0] > 0


def test_the_band_covers_the_truth_as_often_as_it_says():
    """95% bands of 16 seeds hold the true mean in about 90% of experiments (a known shortfall)."""
    values = np.random.default_rng(1).normal(size=(16, 400))
    low, high = band(values)
    assert 0.84 < np.mean((low < 0) & (high > 0)) < 0.97
    assert np.array_equal(band(values), (low, high))
