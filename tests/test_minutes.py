"""Return over minutes: whose clock counts, and what a learner has at a minute."""

import json

import numpy as np

from scripts import minutes


def written(folder, seeds, rate, before):
    """A run of `seeds`; each has the return 10 at 1,000 decisions, 20 at 2,000, ..., 50."""
    folder.mkdir(parents=True)
    rows = [
        {"step": 1000 * k, "seed": seed, "wall_s": 30 + 1000 * k / rate, "eval/return": 10 * k}
        for k in range(1, 6)
        for seed in seeds
    ]
    (folder / "metrics.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    (folder / "summary.json").write_text(json.dumps({"before_s": before}))


def test_learners_that_share_a_program_have_the_clock_of_one_alone(tmp_path):
    """Alone: 1,000 decisions take 10 s after 40 s; together 50 s."""
    for method in ("mixed", "together"):
        written(tmp_path / "robot" / method / "ten", [0, 1], 20, 10)
    written(tmp_path / "robot" / "mixed" / "alone", [7], 100, 10)
    found = minutes.numbers(tmp_path)["minutes"]["robot"]
    assert found["mixed"]["1"] == [20, 20]  # at 60 s: 2,000 decisions
    assert np.isnan(found["mixed"]["2"]).all()  # it ended at 90 s
    assert np.isnan(found["together"]["1"]).all()  # the first evaluation is at 90 s
    assert found["together"]["5"] == [50, 50]


def test_beyond_the_end_of_the_run_alone_its_rate_holds(tmp_path):
    written(tmp_path / "alone", [7], 100, 10)
    time = minutes.clock([minutes.evaluated(tmp_path / "alone")[0]])
    np.testing.assert_allclose(time(np.array([500.0, 3500.0, 9000.0])), [50, 75, 130])
