"""The config.yaml of a run folder builds it again, or is blamed; a start undoes itself."""

import json
import re
import shutil

import pytest
import yaml
from omegaconf import OmegaConf
from tiny import TINY, call_train, contents, demonstrate, finished, refusal, summary_of

from hybrid_rl import __version__, evaluate
from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.errors import UsageError, WorldError
from hybrid_rl.files.lock import lock
from hybrid_rl.run import folder as run_folder
from hybrid_rl.settings import build as config
from hybrid_rl.settings.build import load
from hybrid_rl.training.loop import Loop

# A run of two seeds that is done.
trained = finished("algo=sac", "num_seeds=2", "total_steps=100", "checkpoint_every=50")


def test_a_run_that_is_being_written_is_not_resumed(copied, trained, capfd):
    with lock(copied, "run_dir"):
        line = refusal(capfd, f"resume={copied}", "total_steps=200")
        assert "is being written by process" in line
        (copied / "lock").unlink()
        assert contents(copied) == contents(trained)


HARM = {  # what of config.yaml becomes what, and the words of the line
    "no YAML": (r"\A(.*\n)", r"\1]: [\n", "is no YAML"),
    "no text": ("(?s).+", "\udce9", "is not text (UTF-8)"),
    "empty": ("(?s).+", "", "is empty"),
    "a word": ("(?s).+", "hello", ""),
    "no physics": (r"(?m)^physics:.*\n", "", "Missing key physics"),
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


@pytest.mark.parametrize("kind", HARM)
def test_a_damaged_configuration_is_blamed_on_its_file(copied, capfd, kind):
    (pattern, text, words), file = HARM[kind], copied / "config.yaml"
    file.write_text(re.sub(pattern, text, file.read_text()), errors="surrogateescape")
    before = contents(copied)
    lines = [refusal(capfd, f"run={copied}", of=evaluate.main)]
    assert words in lines[0]
    lines.append(refusal(capfd, f"resume={copied}", "total_steps=200"))
    assert OF_RESUME.get(kind, words) in lines[-1]
    for line in lines:
        assert line.startswith(f"hybrid_rl: {copied}/config.yaml"), line
    assert contents(copied) == before


def test_a_run_goes_on_only_with_the_settings_that_it_began_with(copied, capfd):
    """Though such a configuration builds, and its checkpoint fits."""
    path = copied / "config.yaml"
    text = path.read_text()
    other = text.replace("capacity: 200", "capacity: 300")
    path.write_text(other.replace("_rate: 0.0003", "_rate: 3"))
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
    line = refusal(capfd, f"resume={copied}", "total_steps=0")
    assert "hybrid_rl: total_steps=0: must be" in line


@pytest.mark.parametrize("there", [None, "", "notes.txt"])
def test_a_start_that_fails_leaves_the_disk_as_it_was(tmp_path, monkeypatch, capfd, there):
    """Here for memory."""
    folder = tmp_path / "run"
    if there is not None:
        folder.mkdir()
    if there:
        (folder / there).write_text("mine")
    before = contents(tmp_path)
    monkeypatch.setattr(Loop, "memory", lambda *_: 1e15)
    line = refusal(capfd, *TINY, "algo=sac", f"run_dir={folder}", code=1)
    assert "num_seeds=1: the program would take 1,000,000.0 GB" in line
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


@pytest.fixture
def old(trained, tmp_path):
    """The same, as if version 0.1.0 had made it, whose config.yaml named no version."""
    folder = shutil.copytree(trained, tmp_path / "run")
    file = folder / "config.yaml"
    file.write_text(re.sub(r"(?m)^version: .*\n", "", file.read_text()))
    summary = summary_of(folder)
    summary["versions"]["hybrid_rl"] = "0.1.0"
    (folder / "summary.json").write_text(json.dumps(summary))
    return folder


@pytest.mark.parametrize(
    ("task", "algo"),
    [("halfcheetah", "hybrid_stochastic"), ("pendulum", "kle3"), ("cartpole", "bc")],
)
def test_it_is_short_and_builds_the_same_run(task, algo, tmp_path):
    overrides = [f"task={task}", f"algo={algo}", "total_steps=100"]
    composed = config.load(overrides)
    if algo == "bc":
        composed = config.load([*overrides, demonstrate(tmp_path, composed)])
    run_folder.write(tmp_path, composed)
    text = (tmp_path / "config.yaml").read_text()
    assert text.startswith(f"version: {__version__}\n")
    assert "${" not in text
    assert len(text.splitlines()) < 210
    written = run_folder.read(tmp_path, "run")
    assert "shooting_planner" not in written
    assert config.build(written).agent == config.build(composed).agent


def test_a_folder_above_runs_names_the_newest(tmp_path):
    for time in ("2026-01-01_10-00-00", "2026-01-02_09-00-00"):
        (tmp_path / time).mkdir()
        (tmp_path / time / "config.yaml").touch()
    with pytest.raises(UsageError, match=r"no run folder there .*; in it is .*2026-01-02_\S*$"):
        run_folder.parse_config(tmp_path, "run")


def test_a_word_that_reads_as_a_number_stays_a_word():
    values = {"a": "1e-3", "b": "12", "c": "on", "d": 1e-3, "e": None, "f": ["1", 2], "g": True}
    part = {"_target_": "a.B", **values}
    text = run_folder.as_yaml(OmegaConf.create({"x": part, "y": {"x": part}, "z": [[1], [2]]}))
    assert text.count(" &") == text.count(" *") == 1
    again = yaml.safe_load(text)
    assert again == {"x": part, "y": {"x": part}, "z": [[1], [2]]}
    assert all(type(again["x"][key]) is type(value) for key, value in values.items() if key != "f")


@pytest.mark.parametrize("key", ["run", "resume"])
def test_a_run_of_an_older_version_is_one_line_and_stays(old, tmp_path, capfd, key):
    before, commit = contents(tmp_path), summary_of(old)["git_commit"]
    of = None if key == "resume" else evaluate.main
    assert refusal(capfd, f"{key}={old}", of=of) == (
        f"hybrid_rl: {key}={old}: made by hybrid_rl 0.1.0, and this is {__version__}; "
        f"check out its commit, {commit}, or train again\n"
    )
    assert contents(tmp_path) == before


def test_a_run_of_another_minor_version_is_refused(old):
    major, minor, *_ = map(int, re.findall(r"\d+", __version__))
    file, text = old / "config.yaml", (old / "config.yaml").read_text()
    for version in (f"{major}.{minor - 1}.9", f"{major}.{minor + 1}.0"):
        file.write_text(f"version: {version}\n{text}")
        with pytest.raises(config.UsageError, match=f"made by hybrid_rl {version}, and this is"):
            run_folder.read(old, "run")
    file.write_text(f"version: {major}.{minor}.9\n{text}")
    assert run_folder.read(old, "run").task == "pendulum"


def test_a_setting_is_named_by_its_last_names(trained):
    settings = RunFolder(trained)
    assert settings.word("env") == "Pendulum"
    assert settings.word("full.policy") == settings.word("learners.policy.policy")
    assert settings.number("learners.policy.batch_size") == settings.number("batch_size") == 16
    for key, words in (("hiden", "it has policy.hidden$"), ("_target_", "has several values in ")):
        with pytest.raises(config.UsageError, match=f"group={key}: .*{words}"):
            settings.word(key)
    with pytest.raises(config.UsageError, match=r"x=batch_sise: not in .*batch_size"):
        settings.number("batch_sise")


SWEPT = [
    ("algo=sac", "policy_learner.tau", "0.02"),
    ("algo=hybrid_stochastic settings=light", "policy_learner.discount", "0.9"),
    ("algo=kle3", "target", "mixture"),
]


@pytest.mark.parametrize(("line", "key", "value"), SWEPT)
def test_the_key_that_was_swept_is_a_setting_of_the_run(line, key, value, tmp_path):
    """Though the run is built from `learners` and `controllers`, which refer to it."""
    composed = config.load(["task=pendulum", "total_steps=100", *line.split(), f"{key}={value}"])
    run_folder.write(tmp_path, composed)
    run = RunFolder(tmp_path)
    assert run.word(key).lower() == value
    if key != "target":
        assert run.number(key) == float(value)


def test_every_copy_of_the_world_has_the_same_physics(tmp_path):
    """Also the one in a part, for which `auto` is resolved with the number of worlds."""
    line = ["task=cartpole", "algo=bc", "total_steps=100"]
    composed = config.load([*line, demonstrate(tmp_path, config.load(line))])
    agent = config.build(composed).agent
    worlds = [agent.episode.env, agent.replay.demonstrations.world]
    worlds.append(agent.learners["cloning"].demonstrations.world)
    assert [world.physics for world in worlds] == ["native"] * 3
    assert worlds[0] == worlds[1] == worlds[2]
    assert composed.env.physics == "auto"
