"""The study of Bayesian optimisation with dynamics."""

import json

import numpy as np
import pytest
from tiny import call, rows_of

from hybrid_rl import figures, train
from hybrid_rl.analysis.curves import Curve
from hybrid_rl.cli import command
from hybrid_rl.settings import build as config
from hybrid_rl.thesis.studies import bayesian_optimisation

SHORT = ["episode.steps=80", "total_steps=80", "eval_every=80", "checkpoint_every=80"]
OF_BOTH = ["experiment=thesis/fig_6_4", "num_seeds=2", "compile_cache=null"]


def draw(*arguments) -> int:
    """Exit code of the command."""
    line = "study=bayesian_optimisation", *arguments
    return call(lambda: command.run(figures.main), *line)


def curve(each, notes=()) -> Curve:
    """Trials [S, G] as a curve."""
    seeds, x = tuple(range(len(each))), np.arange(10.0, 10.0 + each.shape[1])
    runs = tuple(map(str, seeds))
    return Curve("t", "m", "a", seeds, runs, x, each, each[0], each[0], each[0], tuple(notes))


def test_runs_become_a_picture_and_its_numbers(tmp_path, capsys) -> None:
    """The greatest V and the best values are those that the run logged."""
    folder = tmp_path / "lqr"
    train.train(config.load([*OF_BOTH, *SHORT, "algo=lqr_bayesopt", f"run_dir={folder}"]))
    out = tmp_path / "s.png"
    assert draw(f"runs={tmp_path}/*", f"out={out}") == 0
    printed = capsys.readouterr().out
    assert "lqr_bayesopt, 2 trials: best value " in printed
    assert "above 95% in 0 of 2; greatest V " in printed
    numbers = json.loads(out.with_suffix(".json").read_text())["lqr_bayesopt"]
    rows = rows_of(folder)
    for seed, peak in enumerate(numbers["V_peak"]):
        logged = [
            row["planner/lyapunov"]
            for row in rows
            if row["seed"] == seed and row.get("planner/lyapunov")
        ]
        assert peak == pytest.approx(max(logged), abs=0.06)
    assert numbers["trials"] == 2
    assert numbers["measurements_to_95_percent"] == [None, None]  # it has hardly moved
    assert out.stat().st_size > 1000


def test_measurements_until_95_percent_by_hand() -> None:
    """The first that is above it, and none if none is."""
    each = np.array([[0.1, 0.96, 0.97, 1.0], [0.2, 0.3, 0.3, 0.95]])
    numbers = bayesian_optimisation.reported(curve(each), None)
    assert numbers["measurements_to_95_percent"] == [2, None]
    assert numbers["median_best_after"] == {4: 0.975}


def test_the_summary_has_a_line_a_method_and_the_notes() -> None:
    """Best value over trials with its band, after how many measurements, and V; each note once."""
    best = np.array([[0.1, 0.96, 0.97, 1.0], [0.2, 0.3, 0.3, 0.9]])
    lyapunov = curve(np.array([[1.0, 3.0], [5.0, 2.0]]), ["one", "two"])
    numbers = {"a": bayesian_optimisation.reported(curve(best, ["one"]), lyapunov)}
    assert bayesian_optimisation.summary(numbers) == [
        "a, 2 trials: best value 0.95 [0.9, 1] after 4; above 95% in 1 of 2, "
        "after 2 measurements (median); greatest V 4 [3, 5]",
        "note: one",
        "note: two",
    ]


def test_a_single_measurement_is_visible(monkeypatch) -> None:
    """As a marker in each panel."""
    one = curve(np.array([[0.5]]))
    monkeypatch.setattr(bayesian_optimisation, "curves", lambda *_, **__: [one])
    monkeypatch.setattr(bayesian_optimisation, "_seconds", lambda curve: curve.x)
    panels = bayesian_optimisation.figure("runs")[0].get_axes()
    assert [panel.lines[0].get_marker() for panel in panels if panel.lines] == ["o", "o", "."]
    assert len(panels) == 4
    assert len(panels[2].collections[0].get_offsets()) == 1
