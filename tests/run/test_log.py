"""Rows are there once; what is printed on the terminal; where numbers come from."""

import json
import os
import re
import struct
import subprocess
import sys
import time

import jax.numpy as jnp
import numpy as np
import pytest
from tensorboardX.proto.event_pb2 import Event

from hybrid_rl.errors import CheckpointError
from hybrid_rl.run.logs import progress
from hybrid_rl.run.logs.log import RunLog, number
from hybrid_rl.run.logs.progress import Progress


def row(step, seed=0, **scalars):
    return {"step": step, "seed": seed, "wall_s": step / 3, **scalars}


def lines(folder):
    return (folder / "metrics.jsonl").read_text().splitlines()


def events(folder):
    """Every event of one TensorBoard folder, oldest file first."""
    result = []
    for path in sorted(folder.glob("events*")):
        data = path.read_bytes()
        while data:
            (size,) = struct.unpack("<Q", data[:8])  # then 4 bytes of checksum, before and after
            result.append(Event.FromString(data[12 : 12 + size]))
            data = data[16 + size :]
    return result


def scalars(folder):
    return [
        (event.step, value.tag, value.simple_value)
        for event in events(folder)
        for value in event.summary.value
    ]


def test_rows_are_json_with_the_digits_of_float32(tmp_path):
    loss = {"model/loss": jnp.float32(0.1), "train/length": np.int32(7), "x": 1e-30}
    with RunLog(tmp_path, [4]) as log:
        log.write([row(1, 4, **loss)])
    assert lines(tmp_path) == [
        '{"step": 1, "seed": 4, "wall_s": 0.333, "model/loss": 0.1, "train/length": 7, "x": 1e-30}'
    ]
    step_tag = [(step, tag) for step, tag, _ in scalars(tmp_path / "tensorboard")]
    assert step_tag == [(1, "model/loss"), (1, "train/length"), (1, "x")]


@pytest.mark.parametrize("value", [np.pi, 1e10, 1.17549435e-38, -0.0, 16777217])
def test_a_number_reads_back_as_the_same_float32(value):
    back = json.loads(json.dumps(number(np.float32(value))))
    assert np.float32(back).tobytes() == np.float32(value).tobytes()


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), jnp.float32(-jnp.inf)])
def test_what_is_not_finite_is_null_and_neither_it_nor_a_word_is_a_scalar(tmp_path, bad):
    with RunLog(tmp_path, [0]) as log:
        log.write([row(1, loss=bad, diverged="sac/q")])
        log.summary({"final_return": [1.5, float(bad)]})
    strict = {"parse_constant": pytest.fail}
    written = json.loads(lines(tmp_path)[0], **strict)
    assert (written["loss"], written["diverged"]) == (None, "sac/q")
    summary = json.loads((tmp_path / "summary.json").read_text(), **strict)
    assert summary == {"final_return": [1.5, None]}
    assert scalars(tmp_path / "tensorboard") == []


def test_several_seeds_have_a_board_each(tmp_path):
    with RunLog(tmp_path, [3, 4]) as log:
        log.write([row(1, 3, a=1), row(1, 4, a=2)])
    assert scalars(tmp_path / "tensorboard" / "seed_3") == [(1, "a", 1)]
    assert scalars(tmp_path / "tensorboard" / "seed_4") == [(1, "a", 2)]


def test_a_rewound_run_has_every_row_once(tmp_path):
    with RunLog(tmp_path, [0]) as log:
        log.write([row(1, a=1), row(2, a=2)])
        offset = log.flush()
        assert offset == (tmp_path / "metrics.jsonl").stat().st_size
        log.write([row(3, a=-1)])
    with (tmp_path / "metrics.jsonl").open("a") as file:
        file.write('{"step": 4, "se')  # a kill in the middle of a row
    with RunLog(tmp_path, [0]) as log:
        assert log.rewind(offset, step=2) == []
        log.write([row(3, a=3)])
        assert log.flush() == (tmp_path / "metrics.jsonl").stat().st_size
    assert [json.loads(line)["a"] for line in lines(tmp_path)] == [1, 2, 3]
    board = events(tmp_path / "tensorboard")
    purged = [event.step for event in board if event.HasField("session_log")]
    assert purged == [3]  # TensorBoard drops what older files have from there on
    assert scalars(tmp_path / "tensorboard")[-1] == (3, "a", 3)


def test_flushed_rows_survive_a_kill(tmp_path):
    code = (
        "import os, signal, sys; from pathlib import Path\n"
        "from hybrid_rl.run.logs.log import RunLog\n"
        "log = RunLog(Path(sys.argv[1]), [0])\n"
        "log.write([{'step': 1, 'seed': 0, 'wall_s': 0, 'a': 5}]); log.flush()\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    subprocess.run([sys.executable, "-c", code, str(tmp_path)], check=False)
    assert json.loads(lines(tmp_path)[0])["a"] == 5
    assert scalars(tmp_path / "tensorboard") == [(1, "a", 5)]


def test_plain_lines_come_at_once_and_then_within_ten_seconds(capsys, monkeypatch):
    """With a speed from the step on from which it is representative."""
    now = [100.0]  # [s]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    monkeypatch.setattr(Progress, "_beat", lambda self: None)  # of its own thread
    with Progress(2000, label="hopper sac", steady=1020) as shown:
        shown.note("compiling ...")
        assert capsys.readouterr().out == "compiling ...\n"
        for step in range(1010, 1200, 10):  # one second each
            now[0] += 1
            shown.update(step, {"train/return": 12.34, "perf/env_steps_per_s": 5e4, "x": 1.0})
        shown.update(1190, {"eval/return": 5.0}, say=True)
    printed = capsys.readouterr().out.splitlines()
    values = "return 12.3  50,000 decisions/s"
    assert printed[0] == f"hopper sac  1,010/2,000 (50%)  {values}"
    assert printed[1] == f"hopper sac  1,090/2,000 (55%)  {values}  0:01:31 left"
    assert [line.split()[2] for line in printed[2:]] == ["1,170/2,000", "1,190/2,000"]
    assert "  return 12.3  eval 5.0  " in printed[-1]
    assert progress.PAUSE + 1 < 10  # the second is the beat's


def test_a_line_comes_while_nothing_is_updated(capsys, monkeypatch):
    """As in a slow call: a thread of its own says it."""
    monkeypatch.setattr(progress, "PAUSE", 0.0)
    with Progress(100, label="ant sac") as shown, shown.doing("compiling"):
        time.sleep(1.2)
    assert "ant sac  0/100 (0%)  compiling for 0:00:01" in capsys.readouterr().out


def test_a_slow_call_has_few_lines(capsys, monkeypatch):
    """Each pause is twice the last."""
    seconds = iter(range(1000))
    shown = Progress(100)
    monkeypatch.setattr(time, "monotonic", lambda: now)
    now = shown._began = 0.0

    def wait(_):
        nonlocal now
        now = float(next(seconds))
        return now > 119

    monkeypatch.setattr(shown._ended, "wait", wait)
    with shown.doing("compiling"):
        shown._beat()
    printed = [line.split()[-1] for line in capsys.readouterr().out.splitlines()]
    assert printed == ["0:00:08", "0:00:24", "0:00:56"]


def test_a_terminal_shows_a_bar():
    """In a pseudo-terminal of 60 columns, since nothing else is one."""
    code = (
        "from hybrid_rl.run.logs.progress import Progress\n"
        "with Progress(2000, 'hopper sac') as shown:\n"
        "    shown.note('compiling [soon] ...')\n"
        "    shown.update(1000, {'train/return': 12.3, 'eval/return': -4.0})\n"
    )
    ours, theirs = os.openpty()
    plain = {"TERM": "xterm", "COLUMNS": "60", "PATH": os.environ["PATH"], "PYTHONUTF8": "1"}
    child = subprocess.Popen([sys.executable, "-c", code], stdout=theirs, stderr=theirs, env=plain)
    os.close(theirs)
    text = b""
    while part := _read(ours):
        text += part
    os.close(ours)
    assert child.wait() == 0
    shown = re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", text.decode())
    assert "compiling [soon] ..." in shown
    assert re.search(r"hopper sac .*1,000/2,000\s+return 12\.3  eval -4\.0", shown)
    assert max(len(line) for line in re.split(r"[\r\n]+", shown)) <= 60


def _read(handle):
    try:
        return os.read(handle, 4096)
    except OSError:  # Linux's end of a pseudo-terminal
        return b""


def test_a_run_whose_folder_was_moved_stops_and_makes_no_new_one(tmp_path):
    folder, elsewhere = tmp_path / "run", tmp_path / "elsewhere"
    folder.mkdir()
    moved = pytest.raises(CheckpointError, match=r"run/metrics\.jsonl: moved, deleted or replaced")
    with RunLog(folder, [0]) as log:
        log.write([row(1)])
        log.flush()
        folder.rename(elsewhere)
        with moved:
            log.flush()
    assert not folder.exists()
    assert len(lines(elsewhere)) == 1


def test_a_console_that_is_closed_ends_nothing(monkeypatch, capfd):
    """As by `| head -1`: what is printed then vanishes, without a word."""
    read, written = os.pipe()
    with open(written, "w") as console, monkeypatch.context() as patch:
        patch.setattr(sys, "stdout", console)
        with Progress(10, label="a run") as shown:
            shown.note("is read")
            assert os.read(read, 100) == b"is read\n"
            os.close(read)
            shown.note("is lost")
            shown.update(3, {}, say=True)
            progress.say("done")
    assert capfd.readouterr() == ("", "")
