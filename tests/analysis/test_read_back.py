"""What tools read of runs: parts, decisions, newer checkpoints, experts."""

import shutil

import numpy as np
import pytest
from tiny import finished, rows_of

import hybrid_rl as hr

folder = finished("algo=sac", "num_seeds=2", "total_steps=550", "replay.capacity=170")


def test_a_run_is_read_and_rebuilt(folder):
    (found,) = hr.runs(folder)
    assert found.rows == rows_of(folder)
    assert found.summary["seeds"] == list(hr.rebuilt(folder).seeds) == [0, 1]
    with pytest.raises(hr.UsageError, match=r"^run=nowhere: no run there"):
        hr.runs("nowhere", "run")


def test_its_decisions_are_those_of_its_rows(folder):
    """One sequence for each learner, in which an observation follows the one before."""
    made, parts = hr.decisions(folder), hr.rebuilt(folder)
    assert made.obs.shape == (2, parts.agent.replay.capacity, 3)  # fewer than the run made
    same = ~(made.truncated + made.terminated).astype(bool)[:, :-1]
    np.testing.assert_array_equal(made.next_obs[:, :-1][same], made.obs[:, 1:][same])


def test_a_newer_checkpoint_is_read_once(folder, tmp_path):
    path = shutil.copytree(folder, tmp_path / "growing")
    first = hr.load(path)
    assert hr.newest(first, path) is None
    hr.train([f"resume={path}", f"total_steps={first.step + 50}"], progress=False)
    later = hr.newest(first, path)
    assert later.step == first.step + 50
    assert hr.newest(later, path) is None


def test_a_scripted_expert_acts_in_its_task():
    words = ["expert=babble", "env.mass=2", "expert.level=0.5"]
    episode, controller = hr.expert("halfcheetah", words)
    assert (episode.env.mass, controller.level) == (2, 0.5)


def test_the_names_are_those_of_the_command():
    assert {"pendulum", "hopper"} <= set(hr.names("task"))
    assert "halfcheetah" in hr.names("policies")
