"""A checkpoint is whole or absent, and comes back bit for bit."""

import errno
import resource
import shutil
import signal
import subprocess
import sys
from threading import Thread
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.errors import CheckpointError
from hybrid_rl.run import checkpoint, leaves


class State(NamedTuple):
    params: dict
    replay: dict | None
    key: jax.Array


def state_at(step: int) -> State:
    nan = np.array([0x7FC12345, 0xFFC00001], np.uint32).view(np.float32)
    return State(
        params={
            "mlp/~/w": jnp.arange(12, dtype=jnp.float32).reshape(3, 4) + step,
            "list": [jnp.full((5,), -0.0), (jnp.asarray(nan), jnp.bfloat16(1.1))],
            "count": jnp.int32(step),
            "mask": jnp.array([False, False]),
        },
        replay={"obs": jnp.zeros((20, 3)).at[3].set(step), "none": jnp.zeros((0, 4), jnp.uint8)},
        key=jax.random.split(jax.random.key(step), 3),
    )


def bits(state: State) -> list[tuple]:
    def of(leaf):
        key = jnp.issubdtype(leaf.dtype, jax.dtypes.prng_key)
        plain = np.asarray(jax.random.key_data(leaf) if key else leaf)
        return str(leaf.dtype), plain.shape, plain.tobytes()

    return [of(leaf) for leaf in jax.tree.leaves(state)]


def assert_same(found: State, expected: State):
    assert jax.tree.structure(found) == jax.tree.structure(expected)
    assert all(isinstance(leaf, jax.Array) for leaf in jax.tree.leaves(found))
    assert bits(found) == bits(expected)


def largest_file(folder):
    return max(
        (path for path in folder.rglob("*") if path.is_file()), key=lambda p: p.stat().st_size
    )


@pytest.fixture
def three(tmp_path):
    for step in (10, 20, 30):
        checkpoint.save(tmp_path, step, state_at(step), {"offset": step})
    return tmp_path


@pytest.mark.parametrize("abstract", [False, True])
def test_every_bit_comes_back(tmp_path, abstract):
    state = state_at(7)
    place = checkpoint.save(tmp_path / "checkpoints", 7, state, {"offset": 3, "note": "caf\u00e9"})
    like = jax.eval_shape(lambda: state) if abstract else state_at(0)
    step, found, meta, notes = checkpoint.restore(tmp_path / "checkpoints", like)
    assert place == tmp_path / "checkpoints" / "7"
    assert (step, meta, notes) == (7, {"offset": 3, "note": "caf\u00e9"}, [])
    assert_same(found, state)
    assert jax.random.normal(found.key[1]) == jax.random.normal(state.key[1])


def test_keys_of_another_kind_come_back(tmp_path):
    key = jax.random.key(3, impl="rbg")
    checkpoint.save(tmp_path, 1, {"key": key}, {})
    _, found, _, _ = checkpoint.restore(tmp_path, {"key": key})
    assert found["key"].dtype == key.dtype
    assert jnp.array_equal(jax.random.key_data(found["key"]), jax.random.key_data(key))


def test_restored_arrays_outlive_the_files_and_can_be_donated(three):
    _, found, _, _ = checkpoint.restore(three, state_at(0))
    shutil.rmtree(three)
    move = jax.jit(lambda params: jax.tree.map(lambda leaf: leaf, params), donate_argnums=0)
    assert move(found.params)["count"] == 30


def test_newest_two_stay(three):
    assert sorted(path.name for path in three.iterdir()) == ["20", "30"]


def test_a_named_step_is_taken(three):
    step, found, meta, _ = checkpoint.restore(three, state_at(0), step=20)
    assert (step, meta) == (20, {"offset": 20})
    assert_same(found, state_at(20))
    with pytest.raises(CheckpointError, match=r"has no checkpoint 10; it has \[20, 30\]"):
        checkpoint.restore(three, state_at(0), step=10)


def test_a_part_of_the_state_is_enough(three):
    part = state_at(0)._replace(replay=None)
    _, found, _, _ = checkpoint.restore(three, part, part=True)
    assert_same(found, state_at(30)._replace(replay=None))
    with pytest.raises(CheckpointError, match=r"replay\.none is there and not here"):
        checkpoint.restore(three, part)


def truncate(place):
    path = largest_file(place / "state")
    path.write_bytes(path.read_bytes()[:-1])
    return "bytes instead of"


def flip(place):
    path = largest_file(place / "state")
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    return "SHA-256 differs"


def flip_meta(place):
    path = place / "meta.json"
    path.write_text(path.read_text().replace("30", "31"))
    return "meta.json has changed"


def delete(place):
    largest_file(place / "state").unlink()
    return "cannot be read"


def cut_manifest(place):
    path = place / "manifest.json"
    path.write_bytes(path.read_bytes()[:-20])
    return "manifest.json cannot be read"


def without_manifest(place):
    (place / "manifest.json").unlink()
    return "its writing was cut off"


HARM = [truncate, flip, flip_meta, delete, cut_manifest, without_manifest]


@pytest.mark.parametrize("harm", HARM)
def test_a_damaged_newest_is_passed_over_and_named(three, harm):
    reason = harm(three / "30")
    step, found, meta, notes = checkpoint.restore(three, state_at(0))
    assert (step, meta) == (20, {"offset": 20})
    assert_same(found, state_at(20))
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
    assert "30" in line
    assert "20" in line
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
    step, found, meta, notes = checkpoint.restore(three, state_at(0))
    assert (step, meta, notes) == (20, {"offset": 21}, [])
    assert_same(found, state_at(21))


def test_a_damaged_one_does_not_count_as_kept(three):
    truncate(three / "30")
    checkpoint.save(three, 40, state_at(40), {})
    assert checkpoint.steps(three) == [20, 40]


KILLED = """
import os, signal, sys
from pathlib import Path
import jax.numpy as jnp
from hybrid_rl.run import checkpoint, leaves
folder = Path(sys.argv[1])
checkpoint.save(folder, 1, {"x": jnp.ones(3)}, {})
checkpoint._rename = lambda draft, place: os.kill(os.getpid(), signal.SIGKILL)
checkpoint.save(folder, 2, {"x": jnp.zeros(3)}, {})
"""


def test_a_kill_before_the_rename_leaves_the_one_before(tmp_path):
    done = subprocess.run([sys.executable, "-c", KILLED, str(tmp_path)], check=False)
    assert done.returncode == -signal.SIGKILL
    assert (tmp_path / ".2.tmp").is_dir()
    step, found, _, notes = checkpoint.restore(tmp_path, {"x": jnp.zeros(3)})
    assert (step, found["x"].tolist(), notes) == (1, [1, 1, 1], [])
    checkpoint.save(tmp_path, 3, {"x": jnp.zeros(3)}, {})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["1", "3"]


BETWEEN = """
import os, signal, sys
from pathlib import Path
import jax.numpy as jnp
from hybrid_rl.run import checkpoint
folder = Path(sys.argv[1])
checkpoint.save(folder, 1, {"x": jnp.ones(3)}, {})
rename = Path.rename
def killed(path, target):
    rename(path, target)
    if target.name == ".1.replaced.tmp":
        os.kill(os.getpid(), signal.SIGKILL)
Path.rename = killed
checkpoint.save(folder, 1, {"x": jnp.zeros(3)}, {})
"""


def test_a_kill_between_the_renames_leaves_the_replaced_one(tmp_path):
    done = subprocess.run([sys.executable, "-c", BETWEEN, str(tmp_path)], check=False)
    assert done.returncode == -signal.SIGKILL
    assert not (tmp_path / "1").exists()
    assert checkpoint.steps(tmp_path) == [1]
    step, found, _, notes = checkpoint.restore(tmp_path, {"x": jnp.zeros(3)})
    assert (step, found["x"].tolist(), notes) == (1, [1, 1, 1], [])
    checkpoint.save(tmp_path, 2, {"x": jnp.zeros(3)}, {})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["1", "2"]


def test_what_another_process_wrote_stays(three):
    """A session deletes what it saw at its start and what it wrote, also beyond its step."""
    checkpoint.save(three, 60, state_at(60), {}, known={20, 30})
    assert checkpoint.steps(three) == [30, 60]
    checkpoint.save(three, 25, state_at(25), {}, known={30, 20})
    assert checkpoint.steps(three) == [25, 60]
    checkpoint.save(three, 40, state_at(40), {}, keep=1, known={25})
    assert checkpoint.steps(three) == [40, 60]


def test_a_folder_is_read_while_its_checkpoints_are_deleted(three, monkeypatch):
    """Each time that one was read in part, its writer deletes it; a newer one is there."""
    read, behind = leaves.read, [30, 40, 50]

    def overtaken(path, like, part):
        got = read(path, like, part)
        if behind:
            checkpoint.save(three, behind.pop(0) + 10, state_at(0), {}, keep=1)
        return got

    monkeypatch.setattr(leaves, "read", overtaken)
    step, _, _, notes = checkpoint.restore(three, state_at(0))
    assert (step, notes) == (60, [])


def test_a_folder_is_read_while_a_thread_saves_and_deletes(tmp_path):
    """Every state that is read is one that was saved, whole."""
    states = {step: {"x": jnp.full(1000, step)} for step in range(1, 16)}
    checkpoint.save(tmp_path, 1, states[1], {"step": 1}, keep=1)

    def go_on():
        for step in range(2, 16):
            checkpoint.save(tmp_path, step, states[step], {"step": step}, keep=1)

    writer = Thread(target=go_on)
    writer.start()
    seen = []
    while writer.is_alive() or not seen:
        step, found, meta, notes = checkpoint.restore(tmp_path, states[1])
        assert (meta["step"], notes) == (step, [])
        assert np.all(found["x"] == step)
        seen.append(step)
    writer.join()
    assert seen == sorted(seen)
    assert checkpoint.steps(tmp_path) == [15]


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
    assert "not written: File too large; checkpoint 30 is whole" in str(caught.value)
    assert capfd.readouterr() == ("", "")
    assert_untouched(three)


def test_a_full_disk_is_one_clear_line(three, monkeypatch):
    def full(path, leaves):
        path.mkdir()
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(leaves, "write", full)
    with pytest.raises(CheckpointError) as caught:
        checkpoint.save(three, 40, state_at(40), {})
    assert str(caught.value) == (
        f"checkpoint 40 in {three} was not written: [Errno 28] No space left on device; "
        "checkpoint 30 is whole"
    )
    assert_untouched(three)


def test_a_disk_too_small_is_not_filled(three, monkeypatch):
    usage = shutil.disk_usage(three)._replace(free=100)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: usage)
    monkeypatch.setattr(leaves, "write", lambda *_: pytest.fail("it was written to"))
    with pytest.raises(CheckpointError, match="it needs 0 MB and the disk has 0 MB left"):
        checkpoint.save(three, 40, state_at(40), {})
    assert_untouched(three)


def test_an_interrupt_leaves_no_draft(three, monkeypatch):
    def interrupted(path, leaves):
        raise KeyboardInterrupt

    monkeypatch.setattr(leaves, "write", interrupted)
    with pytest.raises(KeyboardInterrupt):
        checkpoint.save(three, 40, state_at(40), {})
    assert_untouched(three)


def test_it_says_nothing_on_the_terminal(tmp_path):
    code = KILLED.replace("checkpoint._rename = ", "_ = ") + (
        "checkpoint.restore(folder, {'x': jnp.zeros(3)})\n"
    )
    command = [sys.executable, "-c", code, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_size_is_told_beforehand(tmp_path):
    state = {"x": jnp.zeros((1000, 100)), "key": jax.random.key(0)}
    place = checkpoint.save(tmp_path, 0, state, {})
    written = sum(path.stat().st_size for path in place.rglob("*") if path.is_file())
    assert checkpoint.nbytes(state) == 400_008
    assert 400_000 < written < 420_000
