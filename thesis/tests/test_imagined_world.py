"""thesis/scripts/imagined.py: the future in the learned model beside that of the world."""

import json
import sys

import numpy as np
import pytest
from tiny import call, run

from hybrid_rl.thesis.scripts import imagined


def test_rewards_count_until_an_episode_ends():
    """Of two episodes; the second ends at its seventh decision."""
    ended, rewards = np.zeros((25, 2), bool), np.ones((25, 2))
    ended[6, 1], rewards[6, 1], rewards[7:, 1] = True, 15.0, 1000.0
    found = imagined.measured(ended, rewards)
    assert found["ended"] == [0.0, 0.5, 0.5]
    assert found["reward"] == pytest.approx([1.0, (16 + 15) / 17, (31 + 15) / 32])


def test_a_run_whose_policy_learns_from_a_model(tmp_path):
    """On the pendulum, whose episodes never end and whose rewards lie between -16.3 and 0."""
    run(tmp_path / "run", "algo=hybrid_stochastic")
    out = tmp_path / "imagined.json"
    arguments = [tmp_path / "run", "--after", 3, "--worlds", 8, "--out", out]
    assert call(lambda: sys.exit(imagined.main()), *arguments) == 0
    row = json.loads(out.read_text())["after"]["3"]
    assert row["world"]["ended"] == row["model"]["ended"] == [0.0, 0.0, 0.0]
    assert all(-16.3 < each < 0 for each in row["world"]["reward"])
    assert np.isfinite(row["model"]["reward"]).all()
