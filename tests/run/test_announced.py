"""What a run prints: what to expect, how to go on, how it ended."""

import json
import shlex

import numpy as np
import pytest
from test_session import SAC, when
from tiny import TINY, call_train, rows_of, run

from hybrid_rl.errors import WorldError
from hybrid_rl.run.logs.records import result_line
from hybrid_rl.settings.words import quoted


def test_the_result_is_that_of_the_policy_where_only_it_is_evaluated(tmp_path, capsys):
    result = run(tmp_path / "run", *SAC, "eval_modes=[policy]")
    last = [row for row in rows_of(tmp_path / "run") if "eval/policy_return" in row][-1]
    np.testing.assert_allclose(result["final_eval"][-1], last["eval/policy_return"], rtol=1e-6)
    assert f"eval {np.mean(result['final_eval']):,.1f}" in capsys.readouterr().out


@pytest.mark.parametrize(("step", "saved"), [(60, False), (150, True)])
def test_after_a_fault_of_a_world_it_says_how_to_go_on(monkeypatch, tmp_path, capsys, step, saved):
    folder = tmp_path / "it's"

    def broken(session):
        raise WorldError("reach.py:3: step: the motor is hot")

    when(monkeypatch, step, broken)
    assert call_train(*TINY, *SAC, f"run_dir={quoted(str(folder))}") == 2
    printed = capsys.readouterr()
    assert printed.err == "hybrid_rl: reach.py:3: step: the motor is hot\n"
    lines = [line for line in printed.out.splitlines() if line.startswith("continue: ")]
    command = ["python", "-m", "hybrid_rl.train", f"resume={quoted(str(folder))}"]
    assert [shlex.split(line)[1:] for line in lines] == [command] * saved


def test_the_last_round_of_a_run_may_end_beyond_total_steps(tmp_path, capsys):
    result = run(tmp_path / "b", "algo=sac", "total_steps=300", "num_envs=7", "eval_every=300")
    printed = capsys.readouterr().out
    assert "301/301 (100%)" in printed
    assert result["finished"]


def test_a_run_ends_with_its_curve(tmp_path, capfd):
    folder = tmp_path / "run"
    assert call_train(*TINY, "algo=sac", "eval_every=200", f"run_dir={folder}") == 0
    printed = capfd.readouterr().out
    assert printed.index("compiling on") < printed.index(f"Evaluation return ({folder}/curve.png)")
    assert (folder / "curve.png").stat().st_size > 1000
    (line,) = json.loads((folder / "curve.json").read_text())["curves"]
    evaluated = {r["step"]: r["eval/return"] for r in rows_of(folder) if "eval/return" in r}
    assert dict(zip(line["x"], line["iqm"], strict=True)) == pytest.approx(evaluated)


def test_the_last_line_has_both_returns():
    values = {"final_eval": [-19.0, None, -20.0], "final_return": [-36.4, None, -36.4]}
    assert result_line(values) == (
        "evaluation -19.5 (mean of 2 seeds); "
        "training return -36.4 over the last tenth (mean of 2 seeds)"
    )
