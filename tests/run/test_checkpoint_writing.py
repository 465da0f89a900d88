"""Checkpoints are written while processes are killed, disks are full, and others read them."""

import errno
import resource
import shutil
import signal
import subprocess
import sys

import jax.numpy as jnp
import pytest
from states import assert_same, state_at

from hybrid_rl.errors import CheckpointError
from hybrid_rl.run.checkpoints import checkpoint, leaves

KILLED = """
import os, signal, sys
from pathlib import Path
import jax.numpy as jnp
from hybrid_rl.run.checkpoints import checkpoint, leaves
folder = Path(sys.argv[1])
checkpoint.save(folder, 1, {"x": jnp.ones(3)}, {})
checkpoint._rename = lambda draft, path: os.kill(os.getpid(), signal.SIGKILL)
checkpoint.save(folder, 2, {"x": jnp.zeros(3)}, {})
"""


def test_a_kill_before_the_rename_leaves_the_one_before(tmp_path):
    done = subprocess.run([sys.executable, "-c", KILLED, str(tmp_path)], check=False)
    assert done.returncode == -signal.SIGKILL
    assert any(tmp_path.glob(".2.*.tmp"))
    step, result, _, notes = checkpoint.restore(tmp_path, {"x": jnp.zeros(3)})
    assert (step, result["x"].tolist(), notes) == (1, [1, 1, 1], [])
    checkpoint.save(tmp_path, 3, {"x": jnp.zeros(3)}, {})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["1", "3"]


BETWEEN = """
import os, signal, sys
from pathlib import Path
import jax.numpy as jnp
from hybrid_rl.run.checkpoints import checkpoint
folder = Path(sys.argv[1])
checkpoint.save(folder, 1, {"x": jnp.ones(3)}, {})
rename = Path.rename


def killed(path, target):
    rename(path, target)
    if target.name.startswith(".1.replaced."):
        os.kill(os.getpid(), signal.SIGKILL)
Path.rename = killed
checkpoint.save(folder, 1, {"x": jnp.zeros(3)}, {})
"""


def test_a_kill_between_the_renames_leaves_the_replaced_one(tmp_path):
    done = subprocess.run([sys.executable, "-c", BETWEEN, str(tmp_path)], check=False)
    assert done.returncode == -signal.SIGKILL
    assert not (tmp_path / "1").exists()
    assert checkpoint.steps(tmp_path) == [1]
    step, result, _, notes = checkpoint.restore(tmp_path, {"x": jnp.zeros(3)})
    assert (step, result["x"].tolist(), notes) == (1, [1, 1, 1], [])
    checkpoint.save(tmp_path, 2, {"x": jnp.zeros(3)}, {})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["1", "2"]


def test_a_folder_is_read_while_its_checkpoints_are_deleted(three, monkeypatch):
    """Each time that one was read in part, its writer deletes it; a newer one is there."""
    read, behind = leaves.read, [30, 40, 50]

    def overtaken(path, like):
        got = read(path, like)
        if behind:
            checkpoint.save(three, behind.pop(0) + 10, state_at(0), {}, keep=1)
        return got

    monkeypatch.setattr(leaves, "read", overtaken)
    step, _, _, notes = checkpoint.restore(three, state_at(0))
    assert (step, notes) == (60, [])


def assert_untouched(folder):
    assert sorted(path.name for path in folder.iterdir()) == ["20", "30"]
    assert_same(checkpoint.restore(folder, state_at(0))[1], state_at(30))


def test_a_write_that_fails_halfway_leaves_what_was_there(three, capfd):
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    big = state_at(40)._replace(replay={"obs": jnp.ones((1000, 100)), "none": jnp.zeros(1)})
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, limits[1]))  # [bytes] of any one file
    try:
        with pytest.raises(CheckpointError) as caught:
            checkpoint.save(three, 40, big, {})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert "not written: File too large; checkpoint 30 is intact" in str(caught.value)
    assert capfd.readouterr() == ("", "")
    assert_untouched(three)


def test_an_interrupt_leaves_no_draft(three, monkeypatch):
    def interrupted(path, leaves):
        raise KeyboardInterrupt

    monkeypatch.setattr(leaves, "write", interrupted)
    with pytest.raises(KeyboardInterrupt):
        checkpoint.save(three, 40, state_at(40), {})
    assert_untouched(three)


def test_what_cannot_be_deleted_is_passed_over(three, monkeypatch):
    """A mount, say, or what another process holds open on a network disk."""
    (three / ".40.tmp").mkdir()
    rmtree, stuck = shutil.rmtree, []

    def refuses(path, ignore_errors=False):
        if not path.name.startswith((".40.tmp", ".20.pruned")):
            rmtree(path)
        elif ignore_errors:
            stuck.append(path.name)
        else:
            raise OSError(errno.EBUSY, "Device or resource busy")

    monkeypatch.setattr(shutil, "rmtree", refuses)
    for step in (40, 50, 60):
        checkpoint.save(three, step, state_at(step), {})
        assert_same(checkpoint.restore(three, state_at(0))[1], state_at(step))
    assert sorted(path.name for path in three.iterdir()) == [*sorted({*stuck}), "50", "60"]


def test_a_folder_that_is_gone_is_not_made_again(tmp_path):
    with pytest.raises(CheckpointError, match="No such file or directory"):
        checkpoint.save(tmp_path / "gone" / "checkpoints", 1, state_at(1), {})
    assert list(tmp_path.iterdir()) == []
