"""The command that draws what searches found."""

import json

import numpy as np
import pytest
from tiny import call

from hybrid_rl import command, config, searching, train

SHORT = ["episode.steps=80", "total_steps=80", "eval_every=80", "checkpoint_every=80"]
OF_BOTH = ["experiment=thesis/fig_6_4", "num_seeds=2", "compile_cache=null"]


def test_runs_become_a_picture_and_its_numbers(tmp_path) -> None:
    """The greatest V and the best values are those that the run logged."""
    folder = tmp_path / "lqr"
    train.train(config.load([*OF_BOTH, *SHORT, "algo=lqr_bayesopt", f"run_dir={folder}"]))
    out = tmp_path / "s.png"
    assert call(lambda: command.guarded(searching.main), f"runs={tmp_path}/*", f"out={out}") == 0
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
    said = searching._said(each)
    assert said["measurements_to_95_percent"] == [2, None]
    assert said["median_best_after"] == {4: 0.975}


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
