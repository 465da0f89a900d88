"""Which runs are one curve, and what it is called."""

import pytest
from test_curves import run

from hybrid_rl.analysis.curves import curves
from hybrid_rl.errors import UsageError


def test_runs_of_other_settings_are_other_curves(tmp_path):
    """Named by what differs; the schedule and the physics are no settings."""
    for seed, reward in enumerate(["gymnasium", "pybullet", "pybullet"]):
        more = {"env": f"{{reward: {reward}}}", "total_steps": seed, "physics": seed}
        run(tmp_path / str(seed), [float(seed)], seed, **more)
    one, two = curves(tmp_path)
    assert (one.label, one.seeds) == ("sac reward=gymnasium", (0,))
    assert (two.label, two.seeds, two.notes) == ("sac reward=pybullet", (1, 2), ())
    assert [c.label for c in curves(tmp_path, group="env.reward")] == [
        "env.reward=gymnasium",
        "env.reward=pybullet",
    ]


def test_many_differences_become_letters_with_a_note(tmp_path):
    for seed in range(2):
        run(tmp_path / str(seed), [1.0], seed, **dict.fromkeys("uvwxy", 10 * seed))
    one, two = curves(tmp_path)
    assert (one.label, two.label) == ("sac A", "sac B")
    assert one.notes == ("hopper, sac A: u=0, v=0, w=0, x=0, y=0",)


def test_groups_are_tasks_and_algorithms_or_any_key(tmp_path):
    run(tmp_path / "a", [1.0], algo="sac", num_envs=4, replay="{capacity: 5}")
    run(tmp_path / "b", [2.0], algo="nn_mppi", num_envs=4, replay="{capacity: 6}")
    run(tmp_path / "c", [3.0], algo="sac", task="ant", num_envs=4, replay="{capacity: 6}")
    named = [(curve.task, curve.label) for curve in curves(tmp_path)]
    assert named == [("ant", "sac"), ("hopper", "nn_mppi"), ("hopper", "sac")]
    named = [(curve.task, curve.label) for curve in curves(tmp_path, group="replay.capacity")]
    assert named[1:] == [("hopper", "replay.capacity=5"), ("hopper", "replay.capacity=6")]
    run(tmp_path / "d", [4.0], num_envs=4, replay="{capacity: null}")
    assert "replay.capacity=null" in [
        curve.label for curve in curves(tmp_path, group="replay.capacity")
    ]
    with pytest.raises(UsageError, match=r"group=replay.capacity.more: not in .*config.yaml"):
        curves(tmp_path, group="replay.capacity.more")
    with pytest.raises(UsageError, match=r"group=nothing: not in .*config.yaml"):
        curves(tmp_path, group="nothing")
