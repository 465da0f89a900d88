"""The config.yaml of a run folder is read back or blamed in one line; a start undoes itself."""

import re

import pytest
from tiny import TINY, call, call_train, contents, finished, only_line, refusal

from hybrid_rl import evaluate
from hybrid_rl.cli import command
from hybrid_rl.errors import UsageError, WorldError
from hybrid_rl.files.lock import lock
from hybrid_rl.run import folder as run_folder
from hybrid_rl.settings.build import load
from hybrid_rl.training.loop import Loop

pytestmark = pytest.mark.turns(3)


# A run of two seeds that is done.
trained = finished("algo=sac", "num_seeds=2", "total_steps=100", "checkpoint_every=50")


def test_a_run_that_is_being_written_is_not_resumed(copied, trained, capfd):
    with lock(copied, "run_dir"):
        assert call_train(f"resume={copied}", "total_steps=200") == 2
        assert "is being written by process" in only_line(capfd)
        (copied / "lock").unlink()
        assert contents(copied) == contents(trained)


HARM = {  # what of config.yaml becomes what, and the words of the line
    "no YAML": (r"\A(.*\n)", r"\1]: [\n", "is no YAML"),
    "no text": ("(?s).+", "\udce9", "is not text (UTF-8)"),
    "empty": ("(?s).+", "", "is empty"),
    "a word": ("(?s).+", "hello", ""),
    "no env": (r"(?m)^env:\n(  .*\n)*", "", "lacks env"),
    "no physics": (r"(?m)^physics:.*\n", "", "lacks physics"),
    "seeds": ("num_seeds: 2", "num_seeds: 7", "the learners of seed 0, 1, not of seed 0, 1, 2"),
    "seed": ("\nseed: 0\n", "\nseed: 1\n", "the learners of seed 0, 1, not of seed 1, 2"),
    "value": ("num_envs: 1", "num_envs: 0", "num_envs=0: must be a whole number"),
    "network": (r"hidden: \[16\]", "hidden: [8]", "does not fit this run: learners.policy"),
    "module": (r"hybrid_rl\.envs\.analytic\.pendulum", "kettle", "kettle.Pendulum: is no part of"),
}
OF_RESUME = {  # where its line is another one
    "seeds": "num_seeds was 2 and is 7",
    "seed": "seed was 0 and is 1",
    "network": "hidden was [16] and is [8]",
}


def harm(folder, kind):
    """Harm config.yaml of a run; the words of the line about it."""
    pattern, text, words = HARM[kind]
    file = folder / "config.yaml"
    file.write_text(re.sub(pattern, text, file.read_text()), errors="surrogateescape")
    return words


@pytest.mark.parametrize("kind", HARM)
def test_a_damaged_configuration_is_blamed_on_its_file(copied, capfd, kind):
    words = harm(copied, kind)
    before = contents(copied)
    assert call(lambda: command.run(evaluate.main), f"run={copied}") == 2
    lines = [only_line(capfd)]
    assert words in lines[0]
    assert call_train(f"resume={copied}", "total_steps=200") == 2
    lines.append(only_line(capfd))
    assert OF_RESUME.get(kind, words) in lines[-1]
    for line in lines:
        assert line.startswith(f"hybrid_rl: {copied}/config.yaml"), line
    assert contents(copied) == before


def test_a_run_goes_on_only_with_the_settings_that_it_began_with(copied, capfd):
    """Though such a configuration builds, and its checkpoint fits."""
    path = copied / "config.yaml"
    text = path.read_text()
    path.write_text(
        text.replace("capacity: 200", "capacity: 300").replace("_rate: 0.0003", "_rate: 3")
    )
    before = contents(copied)
    line = refusal(capfd, f"resume={copied}", "total_steps=200")
    assert line.startswith(f"hybrid_rl: {path}: ")
    assert "replay.capacity was 200 and is 300" in line
    assert "learning_rate was 0.0003 and is 3" in line
    assert "with resume only total_steps and precision" in line
    assert contents(copied) == before
    path.write_text(text.replace("compile_cache: null", "compile_cache: elsewhere"))
    assert call_train(f"resume={copied}", "total_steps=150") == 0  # of this machine, not the run


def test_a_broken_world_is_not_blamed_on_the_file(tmp_path):
    with pytest.raises(WorldError, match=r"^w\.py:3: "), run_folder.blame_config(tmp_path):
        raise WorldError("w.py:3: W.step: returned None")


def test_a_value_of_the_user_is_not_blamed_on_the_file(copied, capfd):
    assert call_train(f"resume={copied}", "total_steps=0") == 2
    assert "hybrid_rl: total_steps=0: must be" in only_line(capfd)


@pytest.mark.parametrize("there", [None, "", "notes.txt"])
def test_a_start_that_fails_leaves_the_disk_as_it_was(tmp_path, monkeypatch, capfd, there):
    """Here for memory."""
    folder = tmp_path / "run"
    if there is not None:
        folder.mkdir()
        (folder / (there or "x")).write_text("mine")
        if not there:
            (folder / "x").unlink()
    before = contents(tmp_path)
    monkeypatch.setattr(Loop, "memory", lambda *_: 1e15)
    assert call_train(*TINY, "algo=sac", f"run_dir={folder}") == 1
    assert "num_seeds=1: the program would take 1,000,000.0 GB" in only_line(capfd)
    assert contents(tmp_path) == before


def test_a_folder_of_a_start_that_was_killed_is_taken_and_one_of_a_run_is_not(tmp_path):
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "lock").touch()
    config = load([*TINY, "algo=sac", f"run_dir={tmp_path / 'run'}"])
    with run_folder.claim_folders([config]) as (folder,):
        run_folder.write(folder, config)
    refused = pytest.raises(UsageError, match="holds a run already")
    with refused, run_folder.claim_folders([config]):
        pass


def test_a_start_beside_a_run_that_has_just_begun_deletes_nothing_of_it(tmp_path):
    config = load([*TINY, "algo=sac", f"run_dir={tmp_path / 'run'}"])
    with run_folder.claim_folders([config]) as (folder,):
        (folder / "metrics.jsonl").touch()
        refused = pytest.raises(UsageError, match="is being written by process")
        with refused, run_folder.claim_folders([config]):
            pass
        assert sorted(path.name for path in folder.iterdir()) == ["lock", "metrics.jsonl"]
