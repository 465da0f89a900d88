"""The command that draws what searches found."""

import json

import numpy as np
import pytest
from tiny import call

from hybrid_rl import config, train
from hybrid_rl.cli import command
from hybrid_rl.studies import bayesian_optimisation as searching
from hybrid_rl.studies.curves import Curve

SHORT = ["episode.steps=80", "total_steps=80", "eval_every=80", "checkpoint_every=80"]
OF_BOTH = ["experiment=thesis/fig_6_4", "num_seeds=2", "compile_cache=null"]


def test_runs_become_a_picture_and_its_numbers(tmp_path, capsys) -> None:
    """The greatest V and the best values are those that the run logged."""
    folder = tmp_path / "lqr"
    train.train(config.load([*OF_BOTH, *SHORT, "algo=lqr_bayesopt", f"run_dir={folder}"]))
    out = tmp_path / "s.png"
    assert call(lambda: command.guarded(searching.main), f"runs={tmp_path}/*", f"out={out}") == 0
    printed = capsys.readouterr().out
    assert "lqr_bayesopt, 2 trials: best value " in printed
    assert "above 95% in 0 of 2; greatest V " in printed
    said = json.loads(out.with_suffix(".json").read_text())["lqr_bayesopt"]
    rows = [json.loads(line) for line in (folder / "metrics.jsonl").read_text().splitlines()]
    for seed, peak in enumerate(said["V_peak"]):
        logged = [
            row["planner/lyapunov"]
            for row in rows
            if row["seed"] == seed and row.get("planner/lyapunov")
        ]
        assert peak == pytest.approx(max(logged), abs=0.06)
    assert said["trials"] == 2
    assert said["measurements_to_95_percent"] == [None, None]  # it has hardly moved
    assert out.stat().st_size > 1000


def test_measurements_until_95_percent_by_hand() -> None:
    """The first that reach it, and none where it is never reached."""
    each = np.array([[0.1, 0.96, 0.97, 1.0], [0.2, 0.3, 0.3, 0.95]])
    said = searching.summarise(each)
    assert said["measurements_to_95_percent"] == [2, None]
    assert said["median_best_after"] == {4: 0.975}


def test_a_method_in_words() -> None:
    """Best value over trials with its band, how soon, and how far."""
    numbers = searching.summarise(np.array([[0.1, 0.96, 0.97, 1.0], [0.2, 0.3, 0.3, 0.9]]))
    assert searching.line("a", numbers | {"V_peak": [3.0, 5.0]}) == (
        "a, 2 trials: best value 0.95 [0.9, 1] after 4; above 95% in 1 of 2, "
        "after 2 measurements (median); greatest V 4 [3, 5]"
    )


def test_a_single_measurement_is_visible(tmp_path, monkeypatch) -> None:
    """As a marker in each panel."""
    each = np.array([[0.5]])
    one = Curve("t", "m", "a", (0,), ("r",), np.array([10.0]), each, *[each[0]] * 3, ())
    monkeypatch.setattr(searching, "curves", lambda *_, **__: [one])
    monkeypatch.setattr(searching, "_seconds", lambda curve: curve.x)
    panels = searching.plot("runs")[0].get_axes()
    assert [panel.lines[0].get_marker() for panel in panels if panel.lines] == ["o", "o", "."]
    assert len(panels) == 4
    assert len(panels[2].collections[0].get_offsets()) == 1


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (["runs=nowhere/*"], "no run there"),
        (["out=a.png"], "runs: not given"),
        (["runs=nowhere/*", "out=a.gif"], "must end in .png"),
    ],
)
def test_bad_arguments_are_one_line(given, words, capsys) -> None:
    """And exit code 2."""
    assert call(lambda: command.guarded(searching.main), *given) == 2
    assert words in capsys.readouterr().err
