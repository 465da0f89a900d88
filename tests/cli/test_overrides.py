"""Which keys a run reads, and what is printed of those that it does not read."""

from concurrent.futures import ThreadPoolExecutor
from copy import deepcopy

import pytest
from omegaconf import OmegaConf

from hybrid_rl.settings import build as config
from hybrid_rl.settings import complete
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.groups import options

RAW = {
    "steps": 3,
    "loop": {"part": "${chosen}", "file": "data/${name}.npz", "many": ["${steps}", "${listed}"]},
    "chosen": {"size": "${other.size}", "inner": {"gain": 1}},
    "other": {"size": 2, "gain": 5},
    "idle": {"size": 7, "inner": {"gain": 2}, "part": "${chosen}"},
    "reader": {"wide": "${taken.wide}"},
    "taken": {"_target_": "a.B", "wide": 1},  # a part of which one value is read
    "name": "a",
    "listed": 4,
}


def test_what_is_read_is_followed_through_references():
    read = complete.keys(deepcopy(RAW), ["loop"])
    followed = {"chosen.inner.gain", "chosen.size", "other.size", "name", "listed", "steps"}
    assert followed <= {*read}
    assert not {"other", "other.gain", "idle", "idle.size"} & set(read)


def test_a_key_is_found_where_its_value_is():
    assert complete.found(RAW, "loop.part.inner.gain")[0] == "chosen.inner.gain"
    assert complete.found(RAW, "idle.part")[0] == "idle.part"
    assert complete.select(RAW, "loop.part.nothing") is complete.LACKING


def test_what_is_left_is_what_is_read():
    kept = complete.complete(deepcopy(RAW), ["loop"])
    assert {*kept} == {"steps", "loop", "chosen", "other", "name", "listed"}
    assert kept["other"] == {"size": 2}


@pytest.mark.parametrize("settings", options("settings"))
def test_settings_leave_no_keys_that_only_other_keys_read(settings):
    method = ["algo=hybrid_stochastic"]
    assert {*config.load([*method, f"settings={settings}"])} <= {*config.load(method)}


def test_a_part_has_the_fields_of_its_class_and_the_parts_of_their_names():
    part = {"_target_": "hybrid_rl.controllers.goal.GoalController", "every": 3}
    raw = {"goal": part, "target": {}, "domain": {}, "policy": {}}
    goal = complete.complete(raw, ["goal"])["goal"]
    assert (goal["target"], goal["every"], goal["samples"]) == ("${target}", 3, 1000)


def test_python_refuses_what_the_command_refuses():
    with pytest.raises(config.UsageError, match=r"planner\.horizon: sac has no such key"):
        config.load(["algo=sac", "planner.horizon=7"])
    with pytest.raises(config.UsageError, match="run=nowhere: only the command"):
        config.load(["run=nowhere"])
    assert "planner" not in config.load(["algo=sac", "experiment=thesis/fig_3_2_pendulum"])


def test_threads_compose_at_once():
    with ThreadPoolExecutor(8) as threads:
        made = threads.map(lambda seed: config.load([f"seed={seed}"]).seed, range(16))
        assert list(made) == [*range(16)]


def test_an_override_by_another_key_stays_as_typed():
    task = ["belief.part=${chosen}", "task=pendulum"]
    hydra = OmegaConf.create({"chosen": {"a": 1}, "overrides": {"task": task}})
    assert overrides.of_job(hydra) == task


def test_a_file_with_a_name_of_the_library_is_refused(tmp_path):
    """Hydra would take the library's, and not say so."""
    (tmp_path / "model").mkdir()
    (tmp_path / "model" / "ensemble.yaml").write_text("hidden: [7]\n")
    line = "hybrid_rl has model=ensemble of its own, which a run would take; rename that file"
    with pytest.raises(config.UsageError, match=line):
        config.load(["task=pendulum", "algo=nn_mppi", "model=ensemble"], tmp_path)
