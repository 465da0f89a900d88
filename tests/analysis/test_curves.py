"""Learning curves: which runs are one curve, what is averaged over which seeds, and how."""

import json

import numpy as np
import pytest
from tiny import write_run

from hybrid_rl.analysis.curves import area, band, curves, improvement, iqm
from hybrid_rl.analysis.learning_curves import FEW, comparisons, figure, summary
from hybrid_rl.analysis.results import find
from hybrid_rl.errors import UsageError


def append(folder, **row):
    """One more row of metrics."""
    with (folder / "metrics.jsonl").open("a") as file:
        file.write(json.dumps({"wall_s": row["step"] / 10, "seed": 0, **row}) + "\n")


def run(folder, points, seed=0, task="hopper", algo="sac", metric="train/return", **config):
    """A run folder; points: (step, value), or value alone at 10, 20, ..."""
    lines = "".join(f"{k}: {v}\n" for k, v in {"task": task, "algo": algo, **config}.items())
    pairs = [p if isinstance(p, tuple) else (10 * i, p) for i, p in enumerate(points, 1)]
    return write_run(folder, lines, {metric: {step: [value] for step, value in pairs}}, seed)


def test_seeds_with_common_steps_are_averaged_there(tmp_path):
    data = [[1.0, 2, 3], [3.0, 4, 5], [11.0, 12, 19]]
    for seed, points in enumerate(data):
        run(tmp_path / str(seed), points, seed)
    (curve,) = curves(tmp_path)
    assert (curve.task, curve.label, curve.seeds) == ("hopper", "sac", (0, 1, 2))
    assert curve.x.tolist() == [10, 20, 30]
    assert curve.each.tolist() == data
    np.testing.assert_allclose(curve.iqm, iqm(np.array(data)))
    assert (curve.low <= curve.iqm).all()
    assert (curve.iqm <= curve.high).all()
    assert curve.notes == ()


def test_area_and_improvement(tmp_path):
    """Of two learners whose curves are lines: y = x from 10 on, and y = 20."""
    run(tmp_path / "a", [10.0, 20.0, 30.0], 0)
    run(tmp_path / "b", [20.0, 20.0, 20.0], 1)
    (curve,) = curves(tmp_path)
    np.testing.assert_allclose(area(curve), [20, 20])
    np.testing.assert_allclose(area(curve, 0, 25), [17.5, 20])
    np.testing.assert_allclose(area(curve, 30), [30, 20])
    assert np.isnan(area(curve, 31)).all()
    assert improvement(np.array([1.0, 2]), np.array([1.0, 3]))[0] == (0.5 + 0 + 1 + 0) / 4
    assert improvement(np.array([1.0, 2]), np.array([-1.0, 0])) == (1, 1, 1)


def test_methods_are_compared_where_both_have_values(tmp_path):
    """All learn y = x; one is evaluated later and one ends sooner, which must not count."""
    for algo, steps in (("long", [10, 20, 30]), ("late", [20, 30]), ("short", [10, 15])):
        for seed in range(2):
            points = [(step, float(step + seed)) for step in steps]
            run(tmp_path / algo / str(seed), points, seed, algo=algo)
    numbers = figure(str(tmp_path / "*/*"))[1]
    found = comparisons(curves(tmp_path))
    assert numbers["comparisons"] == found
    assert [(one["label"], one["other"], one["share"], one["between"]) for one in found] == [
        ("late", "long", 0.5, [20, 30]),
        ("long", "short", 0.5, [10, 15]),
    ]
    line = "long ahead of short in 50% [0%, 100%] of pairs of seeds, by the mean between 10 and 15"
    assert line in "\n".join(summary(numbers))


def test_seeds_without_common_steps_meet_on_a_straight_line(tmp_path):
    """Both seeds lie on y = x, so the curve must."""
    rng = np.random.default_rng(0)
    for seed in range(2):
        steps = np.sort(rng.choice(np.arange(1, 10_001), 3000, replace=False)).tolist()
        run(tmp_path / str(seed), [(s, float(s)) for s in [*steps, 10_001]], seed)
    (curve,) = curves(tmp_path)
    assert len(curve.x) == 100
    width = curve.x[1] - curve.x[0]
    np.testing.assert_allclose(curve.iqm[1:], curve.x[1:] - width / 2, atol=0.1 * width)


def test_a_shorter_seed_does_not_cut_the_others(tmp_path):
    """Where both have a value both count; beyond, the one that went on."""
    run(tmp_path / "a", [1.0, 1, 1, 1, 1], 0)
    run(tmp_path / "b", [2.0, 2], 1)
    (curve,) = curves(tmp_path)
    assert curve.x.tolist() == [10, 20, 30, 40, 50]
    assert curve.shared.tolist() == [True, True, False, False, False]
    np.testing.assert_allclose(curve.iqm, [1.5, 1.5, 1, 1, 1])
    assert area(curve).tolist() == [1, 2]
    assert curve.notes == ("hopper, sac: thin where not all seeds have a value, 1 of 2 at 30",)


def test_a_run_without_the_metric_yet_is_left_out_with_a_note(tmp_path):
    run(tmp_path / "a", [1.0], 0)
    late = run(tmp_path / "b", [0.5], 1, metric="sac/alpha")
    run(tmp_path / "d", [0.5], 0, metric="sac/alpha", algo="ddpg")
    (curve,) = curves(tmp_path)
    assert curve.seeds == (0,)
    assert set(curve.notes) == {
        f"hopper, sac: seed 1 of {late} has no train/return yet; left out",
        "hopper, ddpg: no train/return",
    }


def test_a_start_that_failed_is_no_run(tmp_path):
    """It has no config.yaml, and no row or only a lock; alone it is named."""
    failed = tmp_path / "failed"
    failed.mkdir()
    (failed / "lock").touch()
    with pytest.raises(UsageError, match=r"runs=.*: no run there"):
        curves(tmp_path)
    (failed / "metrics.jsonl").touch()
    with pytest.raises(UsageError, match=rf"runs=.*: {failed}/metrics.jsonl: no row of metrics"):
        curves(tmp_path)
    folder = run(tmp_path / "a", [1.0])
    (curve,) = curves(f"{tmp_path}/*")
    assert (curve.runs, curve.notes) == ((str(folder),), ())


def test_failed_evaluations_count_and_cut_nothing(tmp_path):
    """As the lowest value of any learner of the task up to there, including other methods."""
    for seed in range(3):
        run(tmp_path / f"s{seed}", [10.0, 20, 30, 40], seed, metric="eval/return")
    failing = run(tmp_path / "s3", [10.0, None, None, 41], 3, metric="eval/return")
    run(tmp_path / "n", [9.0, 8, -5, 9], 0, algo="nn_mppi", metric="eval/return")
    curve = curves(tmp_path, "eval/return")[1]
    assert curve.x.tolist() == [10, 20, 30, 40]
    assert curve.each[3].tolist() == [10, 8, -5, 41]
    np.testing.assert_allclose(curve.iqm, iqm(curve.each))
    (note,) = curve.notes
    assert note == (
        f"hopper, sac: seed 3 of {failing} is not finite at 20, 30 and counts "
        "as the lowest value that any learner of the task had up to there"
    )


def test_a_learner_that_diverged_counts_to_the_end_of_the_others(tmp_path):
    run(tmp_path / "a", [1.0, 2, 3, 4], 0)
    ended = run(tmp_path / "b", [1.0], 1)
    append(ended, step=15, seed=1, diverged="sac/critic_loss")
    never = run(tmp_path / "c", [], 2)
    append(never, step=5, seed=2, diverged="policy")
    (curve,) = curves(tmp_path)
    assert curve.seeds == (0, 1, 2)
    assert curve.each.tolist() == [[1, 2, 3, 4], [1, 1, 1, 1], [1, 1, 1, 1]]
    assert f"seed 1 of {ended} diverged at 15 (sac/critic_loss) and counts" in curve.notes[0]
    assert f"seed 2 of {never} diverged at 5 (policy) and counts" in curve.notes[1]


def test_of_a_loss_a_failed_learner_has_no_value(tmp_path):
    """What is worst depends on the metric; no line is drawn over the hole."""
    run(tmp_path / "a", [1.0, 2, 3], 0, metric="sac/critic_loss")
    run(tmp_path / "b", [3.0, None, 5], 1, metric="sac/critic_loss")
    (curve,) = curves(tmp_path, "sac/critic_loss")
    np.testing.assert_array_equal(curve.each[1], [3, np.nan, 5])
    assert curve.iqm.tolist() == [2, 2, 4]
    assert "is not finite at 20 and is left out there" in curve.notes[0]


def test_a_seed_that_counts_twice_is_noted(tmp_path):
    run(tmp_path / "a", [1.0], 3)
    run(tmp_path / "b", [2.0], 3)
    (note,) = curves(tmp_path)[0].notes
    assert "seeds [3] are in several run folders" in note


def test_smoothing_is_a_moving_mean_of_that_many_steps(tmp_path):
    points = [0.0, 0, 9, 0, 0, 3]
    (curve,) = curves(run(tmp_path / "a", points), smooth=20)
    np.testing.assert_allclose(curve.iqm, [0, 3, 3, 3, 1, 1.5])


def test_wall_time_is_an_x(tmp_path):
    (curve,) = curves(run(tmp_path / "a", [5.0, 6]), x="wall_s")
    assert curve.x.tolist() == [1, 2]
    with pytest.raises(UsageError, match="x=hours: not in "):
        curves(tmp_path, x="hours")


def test_a_swept_number_is_an_x(tmp_path):
    """The last value of each run over its number; a seed is one learner in all of them."""
    for shown, last in [(10, 7.0), (2, 3.0), (5, 4.0)]:
        for seed in (0, 1):
            folder = tmp_path / f"{shown}-{seed}"
            run(folder, [100.0, last + 2 * seed], seed, data=f"{{shown: {shown}}}")
    (curve,) = curves(tmp_path, x="data.shown")
    assert (curve.x.tolist(), curve.seeds) == ([2, 5, 10], (0, 1))
    assert curve.each.tolist() == [[3, 4, 7], [5, 6, 9]]
    assert curve.iqm.tolist() == [4, 5, 8]
    with pytest.raises(UsageError, match=r"x=task: must be a number; .* has hopper"):
        curves(tmp_path, x="task")


def test_a_run_in_progress_is_read_up_to_its_last_complete_row(tmp_path):
    folder = run(tmp_path / "a", [1.0, 3])
    with (folder / "metrics.jsonl").open("a") as file:
        file.write('{"step": 40, "seed": 0, "train/ret')
    (curve,) = curves(folder)
    assert (curve.x.tolist(), curve.iqm.tolist()) == ([10, 20], [1, 3])


def test_runs_are_found_by_glob_by_folder_and_by_list(tmp_path):
    folders = [run(tmp_path / name / "x", [1.0]) for name in ("a1", "a2", "b")]
    assert find(str(tmp_path / "a*" / "*")) == folders[:2]
    assert find(str(tmp_path / "**")) == folders
    assert find(tmp_path) == folders
    odd = run(tmp_path / "a[1]" / "hidden=[8,8]", [1.0])  # exists, so it is no pattern
    assert find(odd) == find(str(odd.parent)) == [odd]
    assert find([folders[2], tmp_path / "a1"]) == [folders[0], folders[2]]
    for several in (f"{folders[2]},{tmp_path}/a?/x", f"[{tmp_path}/b, {tmp_path}/a[12]]"):
        assert find(several) == [folders[2], *folders[:2]]
    with pytest.raises(UsageError, match=r"runs=none/\*: no run there"):
        find(f"{tmp_path}/b,none/*")


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([7], 7),
        ([1, 2], 1.5),
        ([0, 1, 5], (0.25 * 0 + 1 + 0.25 * 5) / 1.5),
        ([100, 2, 1, 3, -100], (0.75 * 1 + 2 + 0.75 * 3) / 2.5),
        ([4, 1, -9, 100], 2.5),
        ([8, 1, 2, 3, 4, 100], (0.5 * 2 + 3 + 4 + 0.5 * 8) / 3),
    ],
)
def test_iqm_of_few_seeds_weighs_the_border(values, expected):
    assert iqm(np.array(values, float)) == pytest.approx(expected, rel=1e-12)


def test_the_band_of_few_seeds_is_their_range():
    for seeds in range(2, FEW + 1):
        np.testing.assert_allclose(band(np.arange(seeds * 1.0)), [0, seeds - 1])
    assert band(np.arange(FEW + 1.0))[0] > 0


def test_the_band_covers_the_truth_as_often_as_it_says():
    """95% bands of 16 seeds hold the true mean in about 90% of experiments (a known shortfall)."""
    values = np.random.default_rng(1).normal(size=(16, 400))
    low, high = band(values)
    assert 0.84 < np.mean((low < 0) & (high > 0)) < 0.97
    assert np.array_equal(band(values), (low, high))


def test_runs_of_other_settings_are_other_curves(tmp_path):
    """Named by what differs; the schedule and the physics are no settings."""
    for seed, reward in enumerate(["gymnasium", "pybullet", "pybullet"]):
        more = {"env": f"{{reward: {reward}}}", "total_steps": seed, "physics": seed}
        run(tmp_path / str(seed), [float(seed)], seed, **more)
    one, two = curves(tmp_path)
    assert (one.label, one.seeds) == ("sac reward=gymnasium", (0,))
    assert (two.label, two.seeds, two.notes) == ("sac reward=pybullet", (1, 2), ())
    labels = [curve.label for curve in curves(tmp_path, group="env.reward")]
    assert labels == ["env.reward=gymnasium", "env.reward=pybullet"]


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
    labels = [curve.label for curve in curves(tmp_path, group="replay.capacity")]
    assert "replay.capacity=null" in labels
    with pytest.raises(UsageError, match=r"group=replay.capacity.more: not in .*config.yaml"):
        curves(tmp_path, group="replay.capacity.more")
    with pytest.raises(UsageError, match=r"group=nothing: not in .*config.yaml"):
        curves(tmp_path, group="nothing")
