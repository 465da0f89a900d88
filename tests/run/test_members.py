"""Runs that differ in numbers alone train in one program, and each is as if it were alone."""

import json
import shutil

import jax
import numpy as np
import pytest
from programs import shared
from tiny import TINY, call, refusal, rows_of, summary_of

import hybrid_rl
from hybrid_rl import evaluate, export, train
from hybrid_rl.run import members
from hybrid_rl.run.checkpoints import checkpoint

SHORT = [*TINY, "algo=sac", "num_seeds=2", "total_steps=200", "eval_every=200", "log_every=100"]
SHORT += ["checkpoint_every=100"]
SWEEP = ["sweep.policy_learner.discount=[0.9,0.5]", "sweep.policy_learner.alpha=[1.0,0.1]"]
NOT_COMPARED = ("wall_s", "perf/compile_s", "perf/env_steps_per_s")


def trained(*overrides):
    with shared():
        return train.train([*SHORT, *overrides], progress=False)


def rows(folder):
    return [{k: v for k, v in row.items() if k not in NOT_COMPARED} for row in rows_of(folder)]


def same_learners(one, other):
    """Whether all parameters are equal, bit for bit."""
    each = [jax.tree.leaves(hybrid_rl.load(folder).params) for folder in (one, other)]
    return all(np.array_equal(a, b) for a, b in zip(*each, strict=True))


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """A sweep over two keys."""
    folder = tmp_path_factory.mktemp("swept") / "all"
    result = trained(*SWEEP, f"run_dir={folder}")
    assert result["finished"]
    assert result["seeds"] == [0, 1] * 4
    return folder


def test_a_run_of_a_sweep_is_the_run_alone(swept, tmp_path):
    """But for rounding: alone, XLA folds the value into the program."""
    alone = tmp_path / "alone"
    trained("policy_learner.discount=0.5", "policy_learner.alpha=0.1", f"run_dir={alone}")
    for mine, theirs in zip(rows(swept / "3"), rows(alone), strict=True):
        assert list(mine) == list(theirs)
        np.testing.assert_allclose([*mine.values()], [*theirs.values()], 1e-3, 1e-3)
    assert rows(swept / "3") != rows(swept / "2")
    first = [row["sac/alpha"] for row in rows(swept / "3") if "sac/alpha" in row]
    assert 0 < first[0] < 0.11
    same = summary_of(alone).keys()
    assert summary_of(swept / "3").keys() == same


@pytest.mark.parametrize(
    ("task", "key", "value"),
    [
        ("gymnasium", "model_planner.rest", 0.9),
        ("pendulum", "episode.delay", 0.1),
        ("pendulum", "episode.jitter", 0.1),
    ],
)
def test_a_sweep_of_a_world_outside_or_of_one_that_is_late(task, key, value, tmp_path):
    """Training and evaluation have the numbers of each run, and environments its seeds."""
    line = [*TINY, f"task={task}", "algo=nn_mppi", "total_steps=200", "eval_every=200"]
    line += ["env.id=Pendulum-v1"] if task == "gymnasium" else []
    swept, alone = tmp_path / "swept", tmp_path / "alone"
    train.train([*line, f"sweep.{key}=[0.0,{value}]", f"run_dir={swept}"], progress=False)
    train.train([*line, f"{key}={value}", f"run_dir={alone}"], progress=False)
    assert rows(swept / "1") != rows(swept / "0")
    for mine, theirs in zip(rows(swept / "1"), rows(alone), strict=True):
        assert list(mine) == list(theirs)
        np.testing.assert_allclose([*mine.values()], [*theirs.values()], 1e-2, 1e-2)


@pytest.mark.parametrize(
    ("line", "longest"),
    [
        (["sweep.episode.delay=[0,0.2]", "episode.jitter=0.1"], 0.3),
        (["sweep.episode.jitter=[0,0.1]", "episode.delay=0.2"], 0.3),
        (["sweep.episode.jitter=[0,0.1]", "sweep.episode.delay=[0.2,0]"], 0.3),
        (["sweep.episode.jitter=[0,0.1]", "episode.lag=0.4"], 0.4),
        (["sweep.episode.jitter=[0,0.1]", "episode.longest=0.5"], 0.5),
        (["sweep.episode.jitter=[0.1]"], 0),
    ],
)
def test_episodes_of_a_sweep_are_ready_for_its_longest_lag(line, longest):
    made = members.load(["task=pendulum", "algo=sac", *line])
    assert [each.config.episode.longest for each in made] == [pytest.approx(longest)] * len(made)


def test_one_value_is_the_run_without_a_sweep_bit_for_bit(tmp_path):
    value = "policy_learner.discount"
    trained(f"{value}=0.5", f"run_dir={tmp_path / 'plain'}")
    trained(f"sweep.{value}=[0.5]", f"run_dir={tmp_path / 'swept'}")
    assert rows(tmp_path / "swept") == rows(tmp_path / "plain")
    assert same_learners(tmp_path / "swept", tmp_path / "plain")


def test_a_kill_between_two_checkpoints_is_resumed_bit_for_bit(swept, tmp_path):
    folder = tmp_path / "moved"
    shutil.copytree(swept, folder)
    shutil.rmtree(folder / "2" / "checkpoints" / "200")
    with shared():
        result = train.train([f"resume={folder}"], progress=False)
    assert result["finished"]
    for run in map(str, range(4)):
        assert rows(folder / run) == rows(swept / run)
        assert same_learners(folder / run, swept / run)
        assert checkpoint.steps(folder / run / "checkpoints") == [100, 200]


def test_commands_take_one_run_of_a_sweep_or_name_them(swept, tmp_path, capfd):
    assert call(evaluate.main, f"run={swept}", "episodes=1") == 0
    files = [json.loads((swept / str(k) / "evaluation_full.json").read_text()) for k in range(4)]
    assert [file["seeds"] for file in files] == [[0, 1]] * 4
    last = [[r["eval/return"] for r in rows(swept / str(k)) if "eval/return" in r] for k in (0, 3)]
    np.testing.assert_allclose([files[0]["mean"], files[3]["mean"]], last, 1e-4)
    capfd.readouterr()
    out = tmp_path / "policy.stablehlo"
    line = refusal(capfd, f"run={swept}", f"out={out}", of=export.main)
    assert "holds a sweep; give one of its runs" in line
    assert f"{swept / '1'} (policy_learner.discount=0.9 policy_learner.alpha=0.1)" in line
    assert call(export.main, f"run={swept / '1'}", "seed=1", f"out={out}") == 0
    labels = [curve.label for curve in hybrid_rl.curves(swept, "eval/return")]
    assert labels == [f"sac alpha={a} discount={d}" for a in (0.1, 1.0) for d in (0.5, 0.9)]


def test_a_learner_that_diverges_ends_alone(tmp_path, capfd):
    rates = "sweep.policy_learner.policy_learning_rate=[1e30,3e-4]"
    line = refusal(capfd, *SHORT, rates, f"run_dir={tmp_path / 'x'}", code=1)
    assert line.startswith("hybrid_rl: seed 0 of policy_learner.policy_learning_rate=1e+30, step")
    ends = [summary_of(tmp_path / "x" / k) for k in "01"]
    assert [len(each["diverged"]) for each in ends] == [2, 0]
    assert None not in ends[1]["final_eval"]


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("policy_learner.updates=[1,2]", "they decide what is compiled; use -m policy_learner.up"),
        ("policy_learner.tau=[0.1,2]", "policy_learner.tau=2: must lie in (0, 1]"),
        ("policy_learner.tau=0.1", "must be a list of different numbers"),
        ("policy_learner.tau=[0.1,0.1]", "=[0.1, 0.1]: must be a list of different numbers"),
        ("policy_learner.tua=[0.1,0.2]", "sac has no such key; did you mean policy_learner.tau?"),
        ("episode.sensor_noise=[0.1,0.2]", "as they decide what is compiled; use -m"),
        ("seed=[1,2]", "it is no number of a learner or a controller; use -m seed=1,2"),
    ],
)
def test_what_no_program_can_hold_is_refused_in_one_line(key, words, tmp_path, capfd):
    assert words in refusal(capfd, *SHORT, f"sweep.{key}", f"run_dir={tmp_path / 'x'}")
    assert not (tmp_path / "x").exists()
