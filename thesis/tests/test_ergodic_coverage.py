"""The study of ergodic coverage."""

import numpy as np
import pytest
from studied import drawn

from hybrid_rl.settings.build import build, load
from hybrid_rl.thesis.studies import ergodic_coverage
from hybrid_rl.thesis.studies.time_averages import averages, divergences


def test_divergence_falls_as_the_path_becomes_the_target() -> None:
    """Draws of the two Gaussians end low, all draws of one of them high."""
    run = build(load(["experiment=thesis/fig_6_1"]))
    rng = np.random.default_rng(0)
    means = np.array([[0.3, 0.7], [0.7, 0.3]])
    both = means[rng.integers(2, size=500)] + 0.07 * rng.normal(size=(500, 2))
    one = means[0] + 0.07 * rng.normal(size=(500, 2))
    ends = [divergences(run, x)[-1] for x in (both, one)]
    assert -0.02 < ends[0] < 0.1 < 1 < ends[1]


def test_pictures_of_a_path_are_densities() -> None:
    """Their mean is one, and all but the bound have most mass where the path is."""
    x = np.random.default_rng(0).uniform(0.1, 0.4, (300, 2))
    pictures = averages(x)
    assert len(pictures) == 4
    for name, picture in pictures.items():
        assert np.abs(picture).mean() == pytest.approx(1.0, rel=1e-3)
        if "Jensen" not in name:
            assert picture[:50, :50].sum() > 0.8 * picture.sum()


def test_marginals_of_any_task(tmp_path) -> None:
    """A picture, and a share of time for each coordinate of the search."""
    given = ("view=marginals", "task=point_mass", "seeds=2", "steps=20")
    numbers = drawn(tmp_path / "m.png", "ergodic_coverage", *given)
    assert np.shape(numbers["time"]) == np.shape(numbers["target"]) == (2, 30)
    assert np.shape([numbers["total_variation"][name] for name in "xy"]) == (2, 2)


def test_control_records_every_tenth_decision_and_the_last(monkeypatch) -> None:
    rng = np.random.default_rng(0)
    monkeypatch.setattr(ergodic_coverage, "trajectories", lambda *_: rng.uniform(size=(3, 26, 2)))
    monkeypatch.setattr(ergodic_coverage, "divergences", lambda run, x: x[1:, 0])
    _, numbers = ergodic_coverage.figure("control", seeds=3, steps=25)
    assert numbers["kle3"]["t"] == [1, 2, 2.5]
    assert numbers.keys() >= ergodic_coverage.NAMES.keys()
