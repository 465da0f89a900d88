"""Return over minutes: whose clock counts, and what a learner has at a minute."""

import json

import numpy as np

from scripts import minutes


def written(folder, seeds, rate, before, compile_s=0):
    """A run of `seeds`; each has the return 10 at 1,000 decisions, 20 at 2,000, ..., 50."""
    folder.mkdir(parents=True)
    rows = [
        {"step": 1000 * k, "seed": seed, "wall_s": 30 + 1000 * k / rate, "eval/return": 10 * k}
        for k in range(1, 6)
        for seed in seeds
    ]
    (folder / "metrics.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    summary = {"before_s": before, "compile_s": compile_s}
    (folder / "summary.json").write_text(json.dumps(summary))


def test_learners_that_share_a_program_have_the_clock_of_one_alone(tmp_path):
    """Alone: 1,000 decisions take 10 s after 40 s; together 50 s."""
    for method in ("mixed", "together"):
        written(tmp_path / "robot" / method / "ten", [0, 1], 20, 10)
    written(tmp_path / "robot" / "mixed" / "alone", [7], 100, 10)
    numbers = minutes.numbers(tmp_path)
    counted = numbers["decisions"]["robot"]["mixed"]
    assert counted["returns"]["3,000"] == [30, 30]
    assert counted["seconds"] == {f"{k},000": 40 + 10 * k for k in range(1, 6)}
    found = numbers["minutes"]["robot"]
    assert found["mixed"]["1"] == [20, 20]  # at 60 s: 2,000 decisions
    assert np.isnan(found["mixed"]["2"]).all()  # it ended at 90 s
    assert np.isnan(found["together"]["1"]).all()  # the first evaluation is at 90 s
    assert found["together"]["5"] == [50, 50]


def test_beyond_the_end_of_the_run_alone_its_rate_holds(tmp_path):
    written(tmp_path / "alone", [7], 100, 10)
    time = minutes.clock([minutes.evaluated(tmp_path / "alone")[0]])
    np.testing.assert_allclose(time(np.array([500.0, 3500.0, 9000.0])), [50, 75, 130])


def test_methods_that_new_runs_lack_are_kept(tmp_path):
    """The earlier file has ppo and a slow quick; new runs have another quick, and another robot."""
    for day, robot, methods in (
        ("old", "walker2d", ("ppo", "quick")),
        ("new", "walker2d", ("quick",)),
        ("new", "halfcheetah", ("quick", "sac")),
    ):
        for method in methods:
            rate = 50 if day == "old" else 100
            written(tmp_path / day / robot / method / "alone", [7], rate, 10)
    old, new = (minutes.numbers(tmp_path / day) for day in ("old", "new"))
    found = minutes.merged(old | {"made": "on Monday"}, new)
    ends = {(one["task"], one["label"]): one["x"][-1] for one in found["curves"]}
    fast, slow = 40 + 5000 / 100, 40 + 5000 / 50
    robots = {"walker2d": {"ppo": slow, "quick": fast}, "halfcheetah": {"quick": fast, "sac": fast}}
    assert ends == {(r, m): end for r, some in robots.items() for m, end in some.items()}
    assert {robot: {*rows} for robot, rows in found["minutes"].items()} == {
        robot: {*some} for robot, some in robots.items()
    }
    assert found["alone"]["walker2d, settings=quick"]["evaluations"][-1].tolist() == [
        fast,
        5000,
        50,
    ]
    assert found["made"] == "on Monday"


def test_panels_have_one_order_one_time_axis_and_one_legend(tmp_path):
    """Also where the methods have different seeds; grey ends at before_s + compile_s = 30 s."""
    for robot, method, seeds, rate in (
        ("ant", "quick", [0, 1], 50),
        ("legs", "quick", [0], 50),
        ("halfcheetah", "quick", [0], 10),
        ("halfcheetah", "sac", [0], 50),
    ):
        written(tmp_path / robot / method / "run", seeds, rate, 10, compile_s=20)
    picture = minutes.draw(minutes.numbers(tmp_path))
    titles = [axes.get_title() for axes in picture.axes]
    assert titles == ["half-cheetah", "ant", "Go1 follows commands"]
    assert {axes.get_xlim() for axes in picture.axes} == {(0, 9)}  # 540 s
    ends = [[patch.get_x() + patch.get_width() for patch in axes.patches] for axes in picture.axes]
    assert ends == [[0.5], [], [0.5]]  # no ant was alone
    assert not any(axes.get_legend() for axes in picture.axes)
    (legend,) = picture.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "settings=quick (1 seed)",
        "algo=sac settings=quick (1 seed)",
        "settings=quick is compiled",
        "settings=quick (2 seeds)",
    ]
