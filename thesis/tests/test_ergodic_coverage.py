"""The study of ergodic coverage."""

import json

import numpy as np
import pytest
from tiny import call

from hybrid_rl import figures
from hybrid_rl.analysis.curves import spread
from hybrid_rl.cli import command
from hybrid_rl.settings.build import build, load
from hybrid_rl.thesis.studies import ergodic_coverage
from hybrid_rl.thesis.studies.time_averages import averages, divergences


def draw(*arguments) -> int:
    """Exit code of the command."""
    return call(lambda: command.run(figures.main), "study=ergodic_coverage", *arguments)


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


def test_marginals_of_any_task(tmp_path, capsys) -> None:
    """A picture, and a share of time for each coordinate of the search."""
    out = tmp_path / "m.png"
    assert draw("view=marginals", "task=point_mass", "seeds=2", "steps=20", f"out={out}") == 0
    numbers = json.loads(out.with_suffix(".json").read_text())
    assert np.shape(numbers["time"]) == np.shape(numbers["target"]) == (2, 30)
    assert np.shape([numbers["total_variation"][name] for name in "xy"]) == (2, 2)
    assert out.stat().st_size > 1000
    printed = capsys.readouterr().out
    assert printed.startswith("x: total variation of target and time average ")


def test_control_records_every_tenth_decision_and_the_last(monkeypatch, capsys) -> None:
    """The summary has the last one, over seeds; and the legends name methods and colours."""
    rng = np.random.default_rng(0)
    monkeypatch.setattr(ergodic_coverage, "trajectories", lambda *_: rng.uniform(size=(3, 26, 2)))
    monkeypatch.setattr(ergodic_coverage, "divergences", lambda run, x: x[1:, 0])
    picture, numbers = ergodic_coverage.figure("control", seeds=3, steps=25)
    assert numbers["kle3"]["t"] == [1, 2, 2.5]
    lines = ergodic_coverage.summary(numbers)
    for line, (algo, name) in zip(lines, ergodic_coverage.NAMES.items(), strict=True):
        ends = spread(np.array(numbers[algo]["divergence"])[:, -1])
        assert line == f"{name}: D(p || q) {ends} nat after 2.5 s"
    progress = capsys.readouterr().out.splitlines()
    assert [line.split(":")[0] for line in progress] == list(ergodic_coverage.NAMES.values())
    assert "same scale in all panels" in picture.axes[-1].get_ylabel()
    legends = [axes.get_legend() for axes in picture.axes if axes.get_legend()]
    labels = [text.get_text() for text in legends[0].get_texts()]
    assert labels == list(ergodic_coverage.NAMES.values())


def test_summaries_of_the_other_views() -> None:
    average = {"a": 0.123456}, {"a": -0.0}
    assert ergodic_coverage.summary(
        {"view": "average", "total_variation_to_target": average[0], "negative_mass": average[1]}
    ) == ["a: total variation to the target 0.123, negative mass 0"]
    plans = {name: {"dimension": [2], "seconds": [0.0005]} for name in ("kle3", "fourier_ergodic")}
    assert ergodic_coverage.summary({"view": "cost", "repeats": 9, **plans}) == [
        "KL-ergodic, 2 dimensions: 0.5 ms a plan (median of 9)",
        "Fourier, 2 dimensions: 0.5 ms a plan (median of 9)",
    ]
