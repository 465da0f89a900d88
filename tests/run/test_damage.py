"""Damaged checkpoints, full disks, worlds and learners that break: one line, and nothing lost."""

import json
import re

import jax.numpy as jnp
import programs
import pytest
from states import flip
from test_session import break_learner
from tiny import TINY, call_command, call_train, contents, finished, limited, refusal, summary_of

from hybrid_rl import evaluate, export
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.evaluations import Evaluations
from hybrid_rl.run.logs import records
from hybrid_rl.run.machine import memory

trained = finished("algo=sac")  # a run that is done


def test_a_damaged_checkpoint_is_passed_over(copied, capfd):
    flip(copied / "checkpoints" / "600")
    assert call_command(evaluate.main, f"run={copied}", "episodes=1") == 0
    assert "checkpoint 600 is skipped" in " ".join(capfd.readouterr().out.split())
    assert json.loads((copied / "evaluation_full.json").read_text())["step"] == 500
    assert call_command(export.main, f"run={copied}", f"out={copied}/a.stablehlo") == 0
    assert capfd.readouterr().out.count("checkpoint 600 is skipped") == 1
    assert call_train(f"resume={copied}") == 0
    printed = capfd.readouterr()
    assert "checkpoint 600 is skipped" in printed.out
    assert "continuing from step 500" in printed.out
    assert printed.err == ""
    assert checkpoint.verify(copied / "checkpoints" / "600") is None


def test_without_a_sound_checkpoint_nothing_is_done(copied, capfd):
    for step in (500, 600):
        flip(copied / "checkpoints" / str(step))
    before = contents(copied)
    assert "holds no sound checkpoint" in refusal(capfd, f"resume={copied}", code=1)
    assert "holds no sound checkpoint" in refusal(capfd, f"run={copied}", of=evaluate.main, code=1)
    assert contents(copied) == before


def test_a_full_disk_is_named(copied, capfd):
    """Also where the system itself names no file: it refuses any longer than 1,000 bytes."""
    with limited(1000):
        printed = refusal(capfd, f"resume={copied}", "total_steps=700", code=1)
    assert f"File too large: '{copied}/config.yaml'" in printed
    assert checkpoint.steps(copied / "checkpoints") == [500, 600]
    assert not list(copied.glob(".*"))


def test_a_world_that_breaks_is_named_and_can_be_mended(copied, monkeypatch, capfd):
    """From decision 50 of an episode on, its reward is no number."""
    sound = Pendulum.step

    def step(world, state, action):
        now = sound(world, state, action)
        broken = state.clock.decision >= 50
        return now.replace(reward=jnp.where(broken, jnp.nan, now.reward))

    folder = copied.with_name("broken")
    with monkeypatch.context() as patch:
        patch.setattr(Pendulum, "step", step)
        patch.setattr(programs, "KEPT", [])
        line = [*TINY, "algo=sac", "checkpoint_every=50", f"run_dir={folder}"]
        line = refusal(capfd, *line, code=1)
    assert line.startswith("hybrid_rl: seed 0, step 51: world/reward is not finite")
    assert "; checkpoint 50 is intact: fix what fails and resume it" in line
    assert not summary_of(folder)["finished"]
    assert checkpoint.steps(folder / "checkpoints") == [50]
    assert call_train(f"resume={folder}") == 0
    theirs, ours = (copied / "metrics.jsonl", folder / "metrics.jsonl")
    last = [json.loads(path.read_text().splitlines()[-1]) for path in (theirs, ours)]
    assert last[0]["eval/return"] == pytest.approx(last[1]["eval/return"], rel=1e-3)


def test_a_learner_that_breaks_is_named(copied, monkeypatch, capfd):
    """A parameter that is no number is not saved."""
    break_learner(monkeypatch, 0, 650)
    monkeypatch.setattr(records, "infinite", lambda *_: {})
    monkeypatch.setattr(Evaluations, "__call__", lambda *_: [{"eval/return": 0.0}])
    printed = refusal(capfd, f"resume={copied}", "total_steps=700", code=1)
    assert printed.startswith("hybrid_rl: seed 0, step 700: policy.")
    assert " is not finite; checkpoint 600 is intact" in printed
    assert checkpoint.steps(copied / "checkpoints") == [500, 600]


def test_learners_that_do_not_fit_are_counted(tmp_path, monkeypatch, capfd):
    """Before the first decision, from what the compiled program needs."""
    monkeypatch.setattr(memory, "available", lambda: 2e5)  # 16 replay memories, but no more
    line = [*TINY, "algo=sac", "num_seeds=16", f"run_dir={tmp_path / 'many'}"]
    printed = refusal(capfd, *line, code=1)
    result = re.search(r"num_seeds=16: the program would take .*; about (\d+) would fit", printed)
    assert result is not None, printed
    fits = int(result[1])
    assert 0 < fits < 16
    monkeypatch.chdir(tmp_path)
    assert call_train(*line[:-1], f"num_seeds={fits}", "run_dir=few", "total_steps=50") == 0
