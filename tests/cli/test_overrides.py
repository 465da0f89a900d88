"""Which keys a run reads, and what is printed of those that it does not read."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from omegaconf import OmegaConf

from hybrid_rl import config, overrides

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


def test_what_is_read_is_followed_through_interpolations():
    read = overrides.reachable_keys(RAW, ["loop"])
    assert {"chosen.inner.gain", "chosen.size", "other.size", "name", "listed", "steps"} <= set(
        read
    )
    assert not {"other", "other.gain", "idle", "idle.size"} & set(read)


def test_a_key_is_found_where_its_value_is():
    assert overrides.source(RAW, "loop.part.inner.gain") == "chosen.inner.gain"
    assert overrides.source(RAW, "idle.part") == "idle.part"
    assert overrides.select(RAW, "loop.part.nothing") is overrides.LACKING


@pytest.mark.parametrize(
    ("typed", "lost"),
    [
        ("chosen.size=1", {}),
        ("loop.part.inner.gain=1", {}),
        ("other.size=1", {}),
        ("other.gain=1", {"other.gain": "chosen.inner.gain"}),
        ("idle.inner=null", {"idle.inner": "chosen.inner"}),
        ("taken=1", {"taken": ""}),
        ("taken.wide=1", {}),
        ("idle.size=1", {"idle.size": "other.size"}),
        ("+everywhere=1", {}),  # a group that spreads over the whole configuration
        ("~idle.size", {}),
        ("hydra.job.num=1", {}),
    ],
)
def test_a_key_that_nothing_reads_is_named_with_one_that_is_read(typed, lost):
    config = OmegaConf.create(RAW)
    assert overrides.unused(config, overrides.parse([typed]), ["loop", "reader"]) == lost


@pytest.mark.parametrize(
    ("line", "typed", "shown"),
    [
        ("reward='foo': choose", "env.reward=foo", "env.reward=foo: choose"),
        ("total_steps=10000.0: must", "total_steps=1e4", "total_steps=1e4: must"),
        ("planner.rest=nan: must", "model_planner.rest=nan", "model_planner.rest=nan: must"),
        ("planner.rest=2: must", "planner.rest=3", "planner.rest=2: must"),  # not the typed value
        ("hidden=[0]: widths", "policy.hidden=[0]", "policy.hidden=[0]: widths"),
        ("no key in this", "seed=3", "no key in this"),
    ],
)
def test_a_message_shows_what_was_typed(line, typed, shown):
    assert overrides.as_typed(line, [typed, "seed=0"]) == shown


def test_python_refuses_what_the_command_refuses():
    with pytest.raises(config.UsageError, match=r"planner\.horizon: sac does not use it"):
        config.load(["algo=sac", "planner.horizon=7"])
    assert "planner" not in config.load(["algo=sac", "experiment=thesis/fig_3_2_pendulum"])


def test_threads_compose_at_once():
    with ThreadPoolExecutor(8) as threads:
        made = threads.map(lambda seed: config.load([f"seed={seed}"]).seed, range(16))
        assert list(made) == [*range(16)]


def test_in_a_sweep_one_method_that_uses_a_key_is_enough():
    with config.initialize_config_dir(str(config.CONF), version_base="1.3"):
        two = [config.compose("train", [f"algo={algo}"]) for algo in ("sac", "hybrid_stochastic")]
        overrides.refuse_unused(
            two, ["algo=sac,hybrid_stochastic", "planner.horizon=7"], config.READ
        )
        with pytest.raises(config.UsageError, match="sac, hybrid_stochastic do not use it"):
            overrides.refuse_unused(two, ["adjoint_planner.horizon=7,8"], config.READ)


def test_an_override_by_another_key_stays_as_typed():
    task = ["belief.part=${chosen}", "task=pendulum"]
    hydra = OmegaConf.create({"chosen": {"a": 1}, "overrides": {"task": task}})
    assert overrides.of_job(hydra) == task


def test_a_file_with_a_name_of_the_library_is_refused_unless_it_is_a_copy(tmp_path):
    """Hydra would take the library's, and not say so."""
    mine, name = tmp_path / "model" / "gaussian.yaml", "model/gaussian.yaml"
    mine.parent.mkdir()
    mine.write_bytes((config.CONF / name).read_bytes())
    settings = ["task=pendulum", "algo=nn_mppi", "model=gaussian"]
    assert config.load(settings, tmp_path).model.hidden == [200]
    mine.write_text(mine.read_text().replace("[200]", "[7]"))
    line = f"hybrid_rl has model=gaussian of its own, which a run would take; rename {name}"
    with pytest.raises(config.UsageError, match=line):
        config.load(settings, tmp_path)
