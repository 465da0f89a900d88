"""Learning curves: what is averaged over which seeds, at which steps."""

import json

import numpy as np
import pytest
from scipy.stats import trim_mean

from hybrid_rl.config import UsageError
from hybrid_rl.curves import area, band, curves, find, improvement, iqm, steps_to


def run(folder, points, seed=0, task="hopper", algo="sac", metric="train/return", **config):
    """A run folder; points: (step, value), or value alone at 10, 20, ..."""
    folder.mkdir(parents=True)
    said = "".join(f"{k}: {v}\n" for k, v in {"task": task, "algo": algo, **config}.items())
    (folder / "config.yaml").write_text(said)
    with (folder / "metrics.jsonl").open("w") as file:
        for i, point in enumerate(points):
            step, value = point if isinstance(point, tuple) else (10 * (i + 1), point)
            row = {"step": step, "seed": seed, "wall_s": step / 100, metric: value}
            file.write(json.dumps(row) + "\n")
    return folder


@pytest.mark.parametrize("n", [4, 8, 20])
def test_iqm_is_the_trimmed_mean_where_quarters_are_whole(n):
    values = np.random.default_rng(0).normal(size=(n, 3))
    np.testing.assert_allclose(iqm(values), trim_mean(values, 0.25, axis=0), rtol=1e-12)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([7], 7),
        ([1, 2], 1.5),
        ([0, 1, 5], (0.25 * 0 + 1 + 0.25 * 5) / 1.5),
        ([100, 2, 1, 3, -100], (0.75 * 1 + 2 + 0.75 * 3) / 2.5),
        ([8, 1, 2, 3, 4, 100], (0.5 * 2 + 3 + 4 + 0.5 * 8) / 3),
    ],
)
def test_iqm_of_few_seeds_weighs_the_border(values, expected):
    assert iqm(np.array(values, float)) == pytest.approx(expected, rel=1e-12)


def test_the_band_covers_the_truth_as_often_as_it_says():
    """95% bands of 16 seeds hold the true mean in about 90% of experiments (a known shortfall)."""
    values = np.random.default_rng(1).normal(size=(16, 400))
    low, high = band(values)
    assert 0.84 < np.mean((low < 0) & (high > 0)) < 0.97
    assert np.array_equal(band(values), (low, high))


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


def test_area_steps_and_improvement(tmp_path):
    """Of two learners whose curves are lines: y = x from 10 on, and y = 20."""
    run(tmp_path / "a", [10.0, 20.0, 30.0], 0)
    run(tmp_path / "b", [20.0, 20.0, 20.0], 1)
    (curve,) = curves(tmp_path)
    np.testing.assert_allclose(area(curve), [(10 * 10 + 15 * 10 + 25 * 10) / 30, 20])
    assert steps_to(curve, 15).tolist() == [20, 10]
    assert steps_to(curve, 25).tolist() == [30, np.inf]
    assert improvement(np.array([1.0, 2]), np.array([1.0, 3]))[0] == (0.5 + 0 + 1 + 0) / 4
    assert improvement(np.array([1.0, 2]), np.array([-1.0, 0])) == (1, 1, 1)


def test_several_values_at_one_step_are_one_point(tmp_path):
    (curve,) = curves(run(tmp_path / "a", [(10, 1.0), (10, 3.0), (20, 5.0)]))
    assert (curve.x.tolist(), curve.iqm.tolist()) == ([10, 20], [2, 5])


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


def test_a_curve_ends_with_its_shortest_seed_and_says_so(tmp_path):
    run(tmp_path / "a", [1.0, 1, 1, 1, 1], 0)
    run(tmp_path / "b", [2.0, 2], 1)
    (curve,) = curves(tmp_path)
    assert curve.x.tolist() == [10, 20]
    assert curve.notes == (f"hopper, sac: ends at 20 of 50, with seed 1 of {tmp_path / 'b'}",)


def test_a_seed_that_counts_twice_is_told(tmp_path):
    run(tmp_path / "a", [1.0], 3)
    run(tmp_path / "b", [2.0], 3)
    (note,) = curves(tmp_path)[0].notes
    assert "seeds [3] are in several run folders" in note


def test_smoothing_is_a_moving_mean_of_that_many_steps(tmp_path):
    points = [0.0, 0, 9, 0, 0, 3]
    (curve,) = curves(run(tmp_path / "a", points), smooth=20)
    np.testing.assert_allclose(curve.iqm, [0, 3, 3, 3, 1, 1.5])


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
    with pytest.raises(UsageError, match=r"group=replay.capacity.more: .* says nothing of it"):
        curves(tmp_path, group="replay.capacity.more")
    with pytest.raises(UsageError, match=r"group=nothing: .* says nothing of it"):
        curves(tmp_path, group="nothing")


def test_wall_time_is_an_x(tmp_path):
    (curve,) = curves(run(tmp_path / "a", [5.0, 6]), x="wall_s")
    assert curve.x.tolist() == [0.1, 0.2]
    with pytest.raises(UsageError, match="x=hours: must be step, wall_s, or a number"):
        curves(tmp_path, x="hours")


def test_a_swept_number_is_an_x(tmp_path):
    """What each run had at last, over its number; a seed is one learner in all of them."""
    for shown, last in [(10, 7.0), (2, 3.0), (5, 4.0)]:
        for seed in (0, 1):
            place = tmp_path / f"{shown}-{seed}"
            run(place, [100.0, last + 2 * seed], seed, data=f"{{shown: {shown}}}")
    (curve,) = curves(tmp_path, x="data.shown")
    assert (curve.x.tolist(), curve.seeds) == ([2, 5, 10], (0, 1))
    assert curve.each.tolist() == [[3, 4, 7], [5, 6, 9]]
    assert curve.iqm.tolist() == [4, 5, 8]
    with pytest.raises(UsageError, match="x=task: must be step, wall_s, or a number"):
        curves(tmp_path, x="task")


def test_a_run_at_work_and_a_missing_value_are_read(tmp_path):
    folder = run(tmp_path / "a", [1.0, None, 3])
    with (folder / "metrics.jsonl").open("a") as file:
        file.write('{"step": 40, "seed": 0, "train/ret')
    (curve,) = curves(folder)
    assert (curve.x.tolist(), curve.iqm.tolist()) == ([10, 30], [1, 3])


def test_what_does_not_exist_is_named_with_what_does(tmp_path):
    run(tmp_path / "a", [1.0], metric="eval/return")
    with pytest.raises(UsageError, match=r"metric=train/return: .* they have eval/return"):
        curves(tmp_path)
    with pytest.raises(UsageError, match=r"runs=.*nowhere.*: no run there"):
        curves(tmp_path / "nowhere*")


def test_runs_are_found_by_glob_by_folder_and_by_list(tmp_path):
    folders = [run(tmp_path / name / "x", [1.0]) for name in ("a1", "a2", "b")]
    assert find(str(tmp_path / "a*" / "*")) == folders[:2]
    assert find(str(tmp_path / "**")) == folders
    assert find(tmp_path) == folders
    assert find([folders[2], tmp_path / "a1"]) == [folders[0], folders[2]]
