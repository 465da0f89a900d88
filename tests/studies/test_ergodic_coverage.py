"""The command that draws where time went."""

import json
import sys

import numpy as np
import pytest

from hybrid_rl.cli import command
from hybrid_rl.config import build, load
from hybrid_rl.studies import ergodic_coverage as ergodicity
from hybrid_rl.studies.curves import spread


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


def test_marginals_of_any_task(monkeypatch, tmp_path, capsys) -> None:
    """A picture, and a share of time for each coordinate of the search."""
    out = tmp_path / "m.png"
    assert (
        call(monkeypatch, "view=marginals", "task=point_mass", "seeds=2", "steps=20", f"out={out}")
        == 0
    )
    said = json.loads(out.with_suffix(".json").read_text())
    assert np.shape(said["time"]) == np.shape(said["target"]) == (2, 30)
    assert out.stat().st_size > 1000
    printed = capsys.readouterr().out
    assert "point_mass: 2 seeds of 20 decisions\nx: total variation of target and time" in printed


def test_control_prints_its_numbers_and_names_its_colours(monkeypatch, tmp_path, capsys) -> None:
    """A line a method, over seeds; what is printed is the end of what the JSON holds."""
    pictures, rng = [], np.random.default_rng(0)
    monkeypatch.setattr(ergodicity, "paths", lambda *_: rng.uniform(0.2, 0.8, (3, 21, 2)))
    monkeypatch.setattr(ergodicity, "divergences", lambda run, x: x[1:, 0])
    monkeypatch.setattr(ergodicity, "save", lambda *given: pictures.append(given))
    assert (
        call(monkeypatch, "view=control", "seeds=3", "steps=20", f"out={tmp_path / 'c.png'}") == 0
    )
    ((figure, numbers, _),) = pictures
    lines = capsys.readouterr().out.splitlines()
    for line, (algo, name) in zip(lines, ergodicity.NAMES.items(), strict=False):
        ends = spread(np.array(numbers[algo]["divergence"])[:, -1])
        assert line == f"{name}: D(p || q) {ends} nat after 2 s"
    assert "one scale for all" in figure.axes[-1].get_ylabel()
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    assert [text.get_text() for text in legends[0].get_texts()] == list(ergodicity.NAMES.values())


@pytest.mark.parametrize(
    ("given", "words"),
    [("view=nothing", "view=nothing: choose one of control"), ("out=a.gif", "out=a.gif: must end")],
)
def test_bad_arguments(monkeypatch, capsys, given, words) -> None:
    """One line."""
    assert call(monkeypatch, given) == 2
    assert words in capsys.readouterr().err
