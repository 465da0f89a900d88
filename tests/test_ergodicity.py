"""The command that draws where time went."""

import json
import sys

import numpy as np
import pytest

from hybrid_rl import command, ergodicity
from hybrid_rl.config import build, load


def call(monkeypatch, *arguments) -> int:
    """Exit code of the command."""
    monkeypatch.setattr(sys, "argv", ["ergodicity", *map(str, arguments)])
    try:
        command.guarded(ergodicity.main)
    except SystemExit as end:
        return end.code
    return 0


def test_divergence_falls_as_the_path_becomes_the_target() -> None:
    """Draws of the two Gaussians end low, all draws of one of them high."""
    run = build(load(["experiment=thesis/fig_6_1"]))
    rng = np.random.default_rng(0)
    means = np.array([[0.3, 0.7], [0.7, 0.3]])
    both = means[rng.integers(2, size=500)] + 0.07 * rng.normal(size=(500, 2))
    one = means[0] + 0.07 * rng.normal(size=(500, 2))
    ends = [ergodicity.divergences(run, x)[-1] for x in (both, one)]
    assert -0.02 < ends[0] < 0.1 < 1 < ends[1]


def test_pictures_of_a_path_are_densities() -> None:
    """Their mean is one, and all but the bound have most mass where the path is."""
    x = np.random.default_rng(0).uniform(0.1, 0.4, (300, 2))
    pictures = ergodicity.averages(x)
    assert len(pictures) == 4
    for name, picture in pictures.items():
        assert np.abs(picture).mean() == pytest.approx(1.0, rel=1e-3)
        if "Jensen" not in name:
            assert picture[:50, :50].sum() > 0.8 * picture.sum()


def test_marginals_of_any_task(monkeypatch, tmp_path) -> None:
    """A picture, and a share of time for each coordinate of the search."""
    out = tmp_path / "m.png"
    assert (
        call(monkeypatch, "view=marginals", "task=point_mass", "seeds=2", "steps=20", f"out={out}")
        == 0
    )
    said = json.loads(out.with_suffix(".json").read_text())
    assert np.shape(said["time"]) == np.shape(said["target"]) == (2, 30)
    assert out.stat().st_size > 1000


@pytest.mark.parametrize(
    ("given", "words"),
    [("view=nothing", "view=nothing: choose one of control"), ("out=a.gif", "out=a.gif: must end")],
)
def test_bad_arguments(monkeypatch, capsys, given, words) -> None:
    """One line."""
    assert call(monkeypatch, given) == 2
    assert words in capsys.readouterr().err
