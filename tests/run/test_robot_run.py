"""A run on a stand-in robot in processes of their own; what a run on a robot refuses."""

import math
import os
import re
import socket
import subprocess
import sys
import time

import numpy as np
import pytest
from tiny import call_command, refusal

import hybrid_rl
from hybrid_rl import evaluate, robot
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.envs.adapters.stand_in import ACTION, MOVED, RESET, Cartpole
from hybrid_rl.envs.adapters.unstepped import ALONE
from hybrid_rl.errors import UsageError, WorldError
from hybrid_rl.files.lock import lock
from hybrid_rl.outside.robot_process import RobotProcess
from hybrid_rl.outside.row_log import RowLog
from hybrid_rl.settings import build as config
from hybrid_rl.tools.doctor.__main__ import CHECKS, examine
from hybrid_rl.tools.stand_in import Physics
from hybrid_rl.types import Spec

LINE = ["task=robot", "env.make=hybrid_rl.envs.adapters.stand_in:Cartpole", "algo=sac"]
LINE += ["eval_every=100"]
SMALL = [*LINE, "policy.hidden=[8]", "critic.hidden=[8]", "policy_learner.batch_size=8"]
SPEC = Spec(Cartpole.obs, len(Cartpole.low), Cartpole.dt)


@pytest.fixture
def port():
    """That of a stand-in, which ends with the test."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        number = free.getsockname()[1]
    line = [sys.executable, "-m", "hybrid_rl.stand_in", "robot=cartpole", f"port={number}"]
    with subprocess.Popen([*line, "faulty=0.02"], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        process.stdout.readline()
        yield number
        process.terminate()


def test_a_run_on_a_robot(port, tmp_path, capfd):
    folder, rows = tmp_path / "run", []
    line = [*SMALL, f"env.kwargs={{port:{port}}}", "random_steps=20", "checkpoint_every=50"]
    line += ["log_every=25", "episode.steps=30", f"run_dir={folder}"]
    result = hybrid_rl.train([*line, "total_steps=100"], on_row=rows.append, progress=False)
    assert result["finished"]
    means = [row for row in rows if "robot/late_s" in row]
    assert [row["step"] for row in means] == [25, 50, 75, 100]
    assert means[-1]["robot/updates_per_s"] > 0
    result = hybrid_rl.train([f"resume={folder}", "total_steps=150"], progress=False)
    assert result["total_steps"] == 150
    log, sound = RowLog(folder / "robot" / "rows", SPEC), 0
    while (row := log.read(sound)) is not None:
        assert np.abs(row["action"]).max() <= 1
        sound += 1
    assert sound >= 150
    assert set(examine(folder)) <= set(CHECKS)  # without episodes of its own
    moved = subprocess.run(
        [sys.executable, "-m", "hybrid_rl.robot", f"run={folder}", "seconds=1"],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert moved.returncode == 0, moved.stderr
    assert int(re.search(r"(\d+) decisions, ", moved.stdout)[1]) > 10
    capfd.readouterr()
    assert call_command(evaluate.main, f"run={folder}") == 2
    printed = capfd.readouterr()
    assert printed.err == f"hybrid_rl: hybrid_rl.envs.adapters.stand_in_Cartpole: {ALONE}\n"
    assert "compiling" not in printed.out


def test_a_stand_in_obeys_its_driver_after_a_foreign_datagram():
    physics, action = Physics(Cartpole, 0), np.array([2.0], "<f4").tobytes()
    for number in (2**62, time.monotonic_ns()):
        physics._take(MOVED.pack(RESET, number), time.monotonic())
        physics._take(MOVED.pack(ACTION, number) + 2 * action, time.monotonic())  # cut
        physics._take(MOVED.pack(ACTION, number) + action, time.monotonic())
        assert physics.action.tolist() == [2.0 if number < 2**62 else 0.0]
    assert physics.episode == physics.newest == number
    physics.socket.close()


def fill(process, count):
    """Give a robot's process as many rows."""
    log = RowLog(process.folder / "rows", SPEC)
    for n in range(log.count(), count):
        row = np.zeros((), log.kind)
        row["number"] = n
        log.append(row)


def test_a_robot_that_ends_a_run_leaves_what_was_learned(tmp_path, capfd, monkeypatch):
    """As an emergency stop that its class raises."""

    def watch(process):
        fill(process, 3)
        if process.tries:
            raise WorldError("arm.py:39: Stop: pressed")
        process.tries = 1

    monkeypatch.setattr(RobotProcess, "watch", watch)
    monkeypatch.setattr(RobotProcess, "stop", lambda process: None)
    with pytest.raises(WorldError, match="Stop: pressed"):
        hybrid_rl.train([*SMALL, "total_steps=100", f"run_dir={tmp_path / 'run'}"])
    assert (tmp_path / "run" / "checkpoints" / "3").is_dir()
    assert "continue: python -m hybrid_rl.train resume=" in capfd.readouterr().out


def test_a_resumed_run_learns_from_the_rows_that_wait(tmp_path, capfd, monkeypatch):
    def watch(process):
        fill(process, 600)
        process.ended = True

    monkeypatch.setattr(RobotProcess, "watch", watch)
    monkeypatch.setattr(RobotProcess, "stop", lambda process: None)
    line = [*SMALL, "random_steps=0", "log_every=10", f"run_dir={tmp_path / 'run'}"]
    for steps, words in ((20, line), (40, [f"resume={tmp_path / 'run'}"])):
        rows = []
        result = hybrid_rl.train([*words, f"total_steps={steps}"], on_row=rows.append)
        assert result["finished"]
        assert [row["step"] for row in rows if "sac/critic_loss" in row] == [steps - 10, steps]
        assert all(row["robot/updates_per_s"] > 0 for row in rows)
        assert 600 - steps <= rows[-1]["robot/behind"] < 610 - steps
    assert "hybrid_rl: the learner is 5" in capfd.readouterr().err


def test_one_process_moves_a_robot(tmp_path, capfd, monkeypatch):
    """Another one is refused with its number, also after a learner has looked for it."""
    monkeypatch.setattr(robot, "_hurry", lambda: None)
    files = tmp_path / "robot"
    files.mkdir()
    with lock(files, "run"):
        assert RobotProcess(Robot(Cartpole), files).alive()
        line = refusal(capfd, f"run={tmp_path}", of=robot.main)
        assert f"is being written by process {os.getpid()} on" in line
    assert not RobotProcess(Robot(Cartpole), files).alive()


@pytest.mark.parametrize(
    ("name", "value", "line"),
    [
        ("reward", None, "lacks reward"),
        ("dt", None, "dt=null: must be a number"),
        ("dt", math.inf, "dt=inf: must be above 0 and finite"),
        ("obs", 2.5, "obs=2.5: must be a whole number"),
        ("low", [-math.inf], "low=.*: must hold finite numbers"),
        ("safe", [0.0, 0.0, 0.0], "safe=.*: must be one number, or as many as low"),
    ],
)
def test_what_no_robot_can_have_is_named(name, value, line):
    names = {key: getattr(Cartpole, key) for key in dir(Cartpole) if key[:2] != "__"}
    names[name] = value
    if "lacks" in line:
        del names[name]
    with pytest.raises(UsageError, match=line):
        Robot(make=type("Odd", (), names))


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["task=robot", "algo=sac"], "env.make=: cannot be imported .give MODULE:NAME"),
        ([*LINE, "env.stale=0"], r"env\.stale=0: must be above 0"),
        ([*LINE, "env.lag=-1"], "must be 0 or more"),
        ([*LINE, "episode.delay=1"], "put a Gymnasium wrapper around"),
    ],
)
def test_values_that_a_robot_cannot_have_are_refused(words, line):
    with pytest.raises(UsageError, match=line):
        config.build(config.load(words))
