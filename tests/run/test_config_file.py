"""config.yaml of a run: what was built, by which version, and enough to build it again."""

import json
import re
import shutil

import pytest
import yaml
from omegaconf import OmegaConf
from tiny import call, call_train, contents, demonstrate, finished, only_line, summary_of

from hybrid_rl import __version__, evaluate
from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.cli import command
from hybrid_rl.run import folder as run_folder
from hybrid_rl.settings import build as config

METHODS = {"hybrid_stochastic": "halfcheetah", "kle3": "pendulum", "bc": "cartpole"}


# A run that is done.
trained = finished("algo=sac", "total_steps=100", "checkpoint_every=50", "eval_every=100")


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


@pytest.mark.parametrize("algo", METHODS)
def test_it_is_short_and_builds_the_same_run(algo, tmp_path):
    overrides = [f"task={METHODS[algo]}", f"algo={algo}", "total_steps=100"]
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
    if key == "resume":
        assert call_train(f"resume={old}", "total_steps=200") == 2
    else:
        assert call(lambda: command.run(evaluate.main), f"run={old}") == 2
    assert only_line(capfd) == (
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
