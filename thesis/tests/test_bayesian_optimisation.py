"""The study of Bayesian optimisation with dynamics."""

import numpy as np
import pytest
from studied import drawn, trained
from tiny import rows_of

from hybrid_rl.analysis.curves import Curve
from hybrid_rl.thesis.studies import bayesian_optimisation

SHORT = ["experiment=thesis/fig_6_4", "algo=lqr_bayesopt", "num_seeds=2"]
SHORT += ["episode.steps=80", "total_steps=80", "eval_every=80", "checkpoint_every=80"]


def test_measurements_until_95_percent_by_hand() -> None:
    """The first that is above it, and none if none is."""
    each = np.array([[0.1, 0.96, 0.97, 1.0], [0.2, 0.3, 0.3, 0.95]])
    x = np.arange(10.0, 14.0)
    curve = Curve("t", "m", "a", (0, 1), ("0", "1"), x, each, each[0], each[0], each[0], ())
    numbers = bayesian_optimisation.reported(curve, None)
    assert numbers["measurements_to_95_percent"] == [2, None]
    assert numbers["median_best_after"] == {4: 0.975}


def test_runs_become_a_picture_and_its_numbers(tmp_path) -> None:
    """The greatest V are those that the run logged."""
    folder = tmp_path / "lqr"
    trained(*SHORT, f"run_dir={folder}")
    numbers = drawn(tmp_path / "s.png", "bayesian_optimisation", f"runs={tmp_path}/*")
    rows = [row for row in rows_of(folder) if row.get("planner/lyapunov")]
    for seed, peak in enumerate(numbers["lqr_bayesopt"]["V_peak"]):
        logged = [row["planner/lyapunov"] for row in rows if row["seed"] == seed]
        assert peak == pytest.approx(max(logged), abs=0.06)
    assert numbers["lqr_bayesopt"]["trials"] == 2
    assert numbers["lqr_bayesopt"]["measurements_to_95_percent"] == [None, None]  # hardly moved
