"""A run folder belongs to one process."""

import errno
import fcntl
import os
import signal
import socket
import subprocess
import sys

import pytest
from tiny import TINY, call_train, contents, only_line

from hybrid_rl.errors import UsageError
from hybrid_rl.files.lock import lock

HOLD = """
import sys, time
from pathlib import Path
from hybrid_rl.files.lock import lock
with lock(Path(sys.argv[1]), "run_dir"):
    print("held", flush=True)
    time.sleep(60)
"""


@pytest.fixture
def holder(tmp_path):
    """A process that has a folder, and the folder."""
    folder = tmp_path / "held"
    folder.mkdir()
    line = [sys.executable, "-c", HOLD, str(folder)]
    with subprocess.Popen(line, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "held\n"
        yield process, folder
        process.kill()


def test_a_second_process_is_refused_and_names_the_first(holder, capfd):
    process, folder = holder
    (folder / "metrics.jsonl").touch()  # of a run that has just begun
    before = contents(folder)
    assert call_train(*TINY, f"run_dir={folder}") == 2
    who = f"process {process.pid} on {socket.gethostname()}"
    assert f"{folder}: is being written by {who}; wait for it, or stop it" in only_line(capfd)
    assert contents(folder) == before


def test_a_file_that_a_killed_process_left_is_no_lock(holder):
    process, folder = holder
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert (folder / "lock").read_text().startswith(f"process {process.pid}")
    with lock(folder, "run_dir"):
        pass
    assert contents(folder) == {}


def test_one_at_a_time_has_a_folder(tmp_path):
    """The file is deleted at each end: the next holder must not lock a deleted one."""
    code = (
        "import sys\n"
        "from pathlib import Path\n"
        "from hybrid_rl.files.lock import lock\n"
        "from hybrid_rl.errors import UsageError\n"
        "folder, done = Path(sys.argv[1]), 0\n"
        "while done < 200:\n"
        "    try:\n"
        "        with lock(folder, 'run_dir'):\n"
        "            (folder / 'alone').mkdir()\n"  # raises where another one is inside
        "            (folder / 'alone').rmdir()\n"
        "            done += 1\n"
        "    except UsageError:\n"
        "        pass\n"
    )
    line = [sys.executable, "-c", code, str(tmp_path)]
    several = [subprocess.Popen(line, stderr=subprocess.PIPE) for _ in range(2)]
    for process in several:
        assert (process.communicate()[1], process.returncode) == (b"", 0)
    assert contents(tmp_path) == {}


def test_a_disk_without_locks_or_that_fails_is_one_line(tmp_path, monkeypatch, capsys):
    numbers = [errno.ENOLCK, errno.EIO]

    def fails(handle, how):
        raise OSError(numbers[0], os.strerror(numbers.pop(0)))

    monkeypatch.setattr(fcntl, "flock", fails)
    with lock(tmp_path, "run_dir"):
        line = capsys.readouterr().out
    assert line == f"{tmp_path}: this disk has no locks; let no other process write there\n"
    line = rf"run_dir={tmp_path}: cannot be written to \(Input/output error\)"
    with pytest.raises(UsageError, match=line), lock(tmp_path, "run_dir"):
        pass
