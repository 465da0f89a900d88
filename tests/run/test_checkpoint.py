"""A checkpoint is complete or absent, whatever is killed or full, and restored bit for bit."""

import errno
import shutil
import signal
import subprocess
import sys
from contextlib import nullcontext

import jax
import jax.numpy as jnp
import pytest
from states import assert_same, flip, largest_file, state_at
from tiny import limited

from hybrid_rl.errors import CheckpointError
from hybrid_rl.run.checkpoints import checkpoint, leaves


@pytest.mark.parametrize("abstract", [False, True])
def test_every_bit_comes_back(tmp_path, abstract):
    state = state_at(7)
    path = checkpoint.save(tmp_path / "checkpoints", 7, state, {"offset": 3, "note": "caf\u00e9"})
    like = jax.eval_shape(lambda: state) if abstract else state_at(0)
    step, result, meta, notes = checkpoint.restore(tmp_path / "checkpoints", like)
    assert path == tmp_path / "checkpoints" / "7"
    assert (step, meta, notes) == (7, {"offset": 3, "note": "caf\u00e9"}, [])
    assert_same(result, state)
    assert jax.random.normal(result.key[1]) == jax.random.normal(state.key[1])


def test_restored_arrays_outlive_the_files_and_can_be_donated(three):
    _, result, _, _ = checkpoint.restore(three, state_at(0))
    shutil.rmtree(three)
    move = jax.jit(lambda params: jax.tree.map(lambda leaf: leaf, params), donate_argnums=0)
    assert move(result.params)["count"] == 30


def test_a_named_step_is_taken(three):
    step, result, meta, _ = checkpoint.restore(three, state_at(0), step=20)
    assert (step, meta) == (20, {"offset": 20})
    assert_same(result, state_at(20))
    with pytest.raises(CheckpointError, match="holds no checkpoint 10"):
        checkpoint.restore(three, state_at(0), step=10)


def truncate(folder):
    path = largest_file(folder / "state")
    path.write_bytes(path.read_bytes()[:-1])
    return "bytes instead of"


def endless(folder):
    path, files = folder / "manifest.json", '"files": {'
    more = files + '"/dev/zero": {"bytes": 0, "sha256": ""},'
    path.write_text(path.read_text().replace(files, more))
    return "/dev/zero is missing, or no plain file"


def delete(folder):
    largest_file(folder / "state").unlink()
    return "is missing"


def cut_manifest(folder):
    path = folder / "manifest.json"
    path.write_bytes(path.read_bytes()[:-20])
    return "manifest.json cannot be read"


def without_manifest(folder):
    (folder / "manifest.json").unlink()
    return "its writing was cut off"


HARM = [truncate, flip, endless, delete, cut_manifest, without_manifest]


@pytest.mark.parametrize("harm", HARM)
def test_a_damaged_newest_is_passed_over_and_named(three, harm):
    reason = harm(three / "30")
    step, result, meta, notes = checkpoint.restore(three, state_at(0))
    assert (step, meta) == (20, {"offset": 20})
    assert_same(result, state_at(20))
    (note,) = notes
    assert "checkpoint 30 is skipped" in note
    assert reason in note


def test_nothing_sound_is_one_clear_line(three):
    truncate(three / "30")
    flip(three / "20")
    with pytest.raises(CheckpointError) as caught:
        checkpoint.restore(three, state_at(0))
    line = str(caught.value)
    assert "\n" not in line
    assert all(step in line for step in ("20", "30"))
    with pytest.raises(CheckpointError, match="holds no checkpoint"):
        checkpoint.restore(three / "nowhere", state_at(0))


def test_another_run_does_not_fit(three):
    like = state_at(0)
    wider = like._replace(params=like.params | {"count": jnp.zeros(2, jnp.int32)})
    with pytest.raises(CheckpointError, match=r"params\.count is int32\[2\] here and int32\[\]"):
        checkpoint.restore(three, wider)
    more = like._replace(params=like.params | {"new": jnp.zeros(2)})
    with pytest.raises(CheckpointError, match=r"params\.new is float32\[2\] here and absent there"):
        checkpoint.restore(three, more)


def test_a_save_replaces_its_step_and_drops_what_lies_beyond(three):
    flip(three / "30")
    checkpoint.save(three, 20, state_at(21), {"offset": 21})
    assert checkpoint.steps(three) == [20]
    step, result, meta, notes = checkpoint.restore(three, state_at(0))
    assert (step, meta, notes) == (20, {"offset": 21}, [])
    assert_same(result, state_at(21))


def test_a_damaged_one_does_not_count_as_kept(three):
    truncate(three / "30")
    checkpoint.save(three, 40, state_at(40), {})
    assert checkpoint.steps(three) == [20, 40]


@pytest.mark.parametrize("name", ["hidden=[8,8]", "back\\slash", "*", "a b?"])
def test_a_folder_of_any_name_keeps_its_checkpoints(tmp_path, name):
    folder = tmp_path / name
    checkpoint.save(folder, 7, state_at(7), {})
    checkpoint.save(folder, 8, state_at(8), {})
    step, result, _, notes = checkpoint.restore(folder, state_at(0))
    assert (step, notes) == (8, [])
    assert_same(result, state_at(8))


def test_a_checkpoint_without_what_orbax_must_write_is_refused(three, monkeypatch):
    """Its merge of files finds none in a folder whose name it takes as a pattern."""
    monkeypatch.setattr(leaves, "_plain", nullcontext)
    with pytest.raises(CheckpointError, match=r"Orbax left no state/manifest\.ocdbt; there is no"):
        checkpoint.save(three / "[8]", 7, state_at(7), {})
    assert checkpoint.steps(three) == [20, 30]


KILLED = """
import os, signal, sys
from pathlib import Path
import jax.numpy as jnp
from hybrid_rl.run.checkpoints import checkpoint
folder, step, rename = Path(sys.argv[1]), int(sys.argv[2]), Path.rename
checkpoint.save(folder, 1, {"x": jnp.ones(3)}, {})


def killed(path, target):
    if step == 1:
        rename(path, target)
    os.kill(os.getpid(), signal.SIGKILL)
Path.rename = killed
checkpoint.save(folder, step, {"x": jnp.zeros(3)}, {})
"""


@pytest.mark.parametrize("step", [1, 2])
def test_a_kill_before_or_between_the_renames_leaves_the_one_before(tmp_path, step):
    """A second one of the same step: between the two renames."""
    line = [sys.executable, "-c", KILLED, str(tmp_path), str(step)]
    assert subprocess.run(line, check=False).returncode == -signal.SIGKILL
    assert any(tmp_path.glob(f".{step}.*.tmp"))
    assert (tmp_path / "1").exists() == (step == 2)
    assert checkpoint.steps(tmp_path) == [1]
    found, result, _, notes = checkpoint.restore(tmp_path, {"x": jnp.zeros(3)})
    assert (found, result["x"].tolist(), notes) == (1, [1, 1, 1], [])
    checkpoint.save(tmp_path, 3, {"x": jnp.zeros(3)}, {})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["1", "3"]


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
    big = state_at(40)._replace(replay={"obs": jnp.ones((1000, 100)), "none": jnp.zeros(1)})
    with limited(100_000), pytest.raises(CheckpointError) as caught:
        checkpoint.save(three, 40, big, {})
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
