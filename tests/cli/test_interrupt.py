"""Ctrl-C and SIGTERM, from the first moment of a command on; real processes and real signals."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from tiny import TINY

from hybrid_rl.cli import interrupt

ROOT = Path(__file__).parents[2]
WORDS = {
    signal.SIGINT: "interrupted",
    signal.SIGTERM: "terminated",
    signal.SIGHUP: "terminated, as its terminal was closed (SIGHUP)",
    signal.SIGUSR1: "terminated by SIGUSR1",
}
BEGIN = """
import signal, sys, time
from hybrid_rl.cli import interrupt
interrupt.install()
interrupt.PATIENCE = 0.2
def say(text):
    print(text, flush=True)
"""


@pytest.fixture(autouse=True)
def _heard():
    """Processes begin with the system's answer to SIGHUP, also if these tests run under nohup."""
    before = signal.signal(signal.SIGHUP, lambda *_: None)  # no process inherits a handler
    yield
    signal.signal(signal.SIGHUP, before)


def start(*arguments):
    pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    return subprocess.Popen([sys.executable, *arguments], cwd=ROOT, text=True, **pipes)


def ended(process, number):
    """What was printed on stdout, of a process that ended by `number`, with one line on stderr."""
    out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (128 + number, f"hybrid_rl: {WORDS[number]}\n"), out
    return out


def listens(process):
    """Whether the process has a handler of SIGTERM, which Python itself does not set."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    caught = int(re.search(r"SigCgt:\s*(\w+)", status)[1], 16)
    return bool(caught >> (signal.SIGTERM - 1) & 1)


@pytest.mark.parametrize(
    ("command", "number", "after"),
    [
        ("train task=pendulum algo=sac", signal.SIGTERM, 0.3),
        ("evaluate run=nowhere", signal.SIGINT, 0.0),
    ],
)
def test_a_signal_during_imports_is_one_line(command, number, after, tmp_path):
    name, *arguments = command.split()
    more = [f"run_dir={tmp_path}"] if name == "train" else []
    process = start("-m", f"hybrid_rl.{name}", *arguments, *more)
    while not listens(process):
        time.sleep(0.001)
    time.sleep(after)
    process.send_signal(number)
    assert ended(process, number) == ""


def test_a_command_starts_no_process_while_it_imports(monkeypatch):
    """A child gets the terminal's Ctrl-C too, and would print a traceback of its own."""
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    code = """
sys.addaudithook(lambda event, what: event == "subprocess.Popen" and say(what[1]))
import hybrid_rl.train, hybrid_rl.envs.mujoco.offscreen
"""
    out, err = start("-c", BEGIN + code).communicate(timeout=60)
    assert (out, err) == ("", "")


def test_a_signal_during_compiling_ends_the_run_at_once(tmp_path):
    off = ["compile_cache=null", f"run_dir={tmp_path}", "policy.hidden=[24,24]"]
    process = start("-m", "hybrid_rl.train", *TINY, "algo=hybrid_stochastic", *off)
    while "compiling on" not in process.stdout.readline():
        assert process.poll() is None
    process.send_signal(signal.SIGINT)
    assert "compiled" not in ended(process, signal.SIGINT)
    assert not (tmp_path / "checkpoints").exists()


def press(code, *numbers):
    """A program that says "ready" gets signals, each after a line of its own."""
    process = start("-c", BEGIN + code)
    for number in numbers:
        assert process.stdout.readline()
        process.send_signal(number)
    return process


def test_a_run_is_asked_once_and_a_second_ctrl_c_ends_it():
    code = "with interrupt.as_call(say):\n    say('ready')\n    time.sleep(60)\n"
    process = press(code, signal.SIGINT, signal.SIGINT)  # the second one after it printed 2
    ended(process, signal.SIGINT)


@pytest.mark.parametrize(
    ("first", "second"), [(signal.SIGTERM, signal.SIGINT), (signal.SIGHUP, signal.SIGUSR1)]
)
def test_after_sigterm_one_more_signal_of_any_kind_changes_nothing(first, second):
    code = (
        "with interrupt.as_call(say):\n    say('ready')\n    sys.stdin.readline()\n"
        "    time.sleep(0.2)\n    say('saved')\n"
    )
    process = press(code, first, second)
    assert process.communicate("\n")[0] == "saved\n"
    assert process.returncode == 0


def test_signals_that_come_together_ask_once():
    code = "with interrupt.as_call(say):\n    say('ready')\n    time.sleep(0.3)\n    say('saved')\n"
    process = press(code, signal.SIGSTOP)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGCONT):
        process.send_signal(number)
    asked, end = process.communicate()[0].split()
    assert (int(asked) in WORDS, end, process.returncode) == (True, "saved", 0)


def test_a_process_under_nohup_is_deaf_to_its_terminal():
    ignored = "signal.signal(signal.SIGHUP, signal.SIG_IGN)\ninterrupt.install"
    code = BEGIN.replace("interrupt.install", ignored)
    code += "with interrupt.as_call(say):\n    signal.raise_signal(signal.SIGHUP)\n"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGUSR1])
def test_a_job_cleans_up(number):
    code = """
from hybrid_rl.cli import command
def job():
    try:
        say('ready')
        time.sleep(60)
    finally:
        say('clean')
command.run(job)
"""
    assert ended(press(code, number), number) == "clean\n"


def test_a_swallowed_interrupt_ends_the_process_all_the_same():
    code = """
with interrupt.as_exception():
    while True:
        try:
            say('ready')
            time.sleep(60)
        except BaseException: pass
"""
    ended(press(code, signal.SIGINT), signal.SIGINT)


def test_a_notebook_is_asked_too_and_keeps_its_handlers():
    asked, before = [], signal.getsignal(signal.SIGINT)

    def job():
        with interrupt.as_call(asked.append):
            os.kill(os.getpid(), signal.SIGINT)
            while not asked:
                time.sleep(0.001)
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1)

    with pytest.raises(KeyboardInterrupt):
        job()
    assert asked == [signal.SIGINT]
    assert signal.getsignal(signal.SIGINT) is before
    assert not interrupt.installed()


def test_output_without_a_reader_ends_in_silence():
    """As in `| head`."""
    process = start("-m", "hybrid_rl.list")
    process.stdout.close()
    process.stdout = None
    assert process.communicate(timeout=60)[1] == ""
    assert process.returncode == 1
