"""The study of clones that query their teacher."""

from pathlib import Path
from typing import Any

import jax
import numpy as np
import pytest
from studied import code, drawn, trained
from tiny import rows_of

from hybrid_rl.settings import build as config
from hybrid_rl.thesis.studies import queries
from hybrid_rl.training.rollout import evaluate_episodes, evaluation_keys
from hybrid_rl.types import Params

SHORT = [
    *(
        "task=cart_pendulum",
        "expert=regulator",
        "dagger_learner.first=20",
        "policy.hidden=[8]",
        "num_seeds=2",
    ),
    *("total_steps=80", "eval_every=20", "eval_episodes=3", "eval_modes=[policy]"),
    *("checkpoint_every=80", "log_every=20"),
]


def test_a_share_reaches_90_percent_at_the_first_crossing() -> None:
    """Of the interquartile mean."""
    each = np.array([[0.1, 0.95, 0.5, 1.0], [0.1, 0.93, 0.7, 0.9]])
    assert queries._reported(np.arange(4), each)["reaches"] == 1
    assert queries._reported(np.arange(4), each / 2)["reaches"] is None


def test_a_refit_uses_the_labels_of_the_first_demonstrations(runs: Path) -> None:
    """No step is taken for a clone whose weights it would change; few labels give other clones."""
    folder = runs / "b"
    row = queries._row("b", folder, queries._config(folder), "eval/policy_success")
    none, some = (queries.refitted(row, steps, [0, 3], "return") for steps in (0, 30))
    np.testing.assert_array_equal(none[:, 0], none[:, 1])
    assert (some[:, 0] != some[:, 1]).all()


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of two runs."""
    folder = tmp_path_factory.mktemp("queries")
    for name, *more in (("b", "algo=rq_dagger"), ("a", "algo=dagger", "taught.decisions=[80]")):
        trained(*SHORT, *more, f"run_dir={folder / name}")
    return folder


def test_shares_are_those_of_the_teacher(runs: Path) -> None:
    """Scores in the log, over those of the teacher from the same first states."""
    given = (f"runs={runs}/*", "refit=4", "at=0,2")
    numbers = drawn(runs.parent / "shares.png", "imitation", *given)
    assert list(numbers["methods"]) == ["RQ-DAgger", "behaviour cloning"]
    run = config.build(config.load([*SHORT, "algo=dagger"]))
    learner: Any = run.agent.learners["policy"]
    keys: Any = np.concatenate([jax.random.key_data(evaluation_keys(seed, 3)) for seed in (0, 1)])
    scores = evaluate_episodes(
        run.agent.episode, learner.teacher, Params(), jax.random.wrap_key_data(keys)
    )
    name = "eval/policy_success"
    assert numbers["teacher"] == pytest.approx(float(scores["success"].mean()), rel=1e-3)
    for label, folder in (("RQ-DAgger", "b"), ("behaviour cloning", "a")):
        one = numbers["methods"][label]
        assert one["N"] == [0, 1, 2, 3]
        rows = [row for row in rows_of(runs / folder) if name in row]
        for seed in (0, 1):
            logged = [row[name] for row in rows if row["seed"] == seed]
            shares = np.array(one["each"][seed])
            np.testing.assert_allclose(shares * numbers["teacher"], logged, rtol=1e-3)
        assert one["refit"]["N"] == [0, 2]
        assert np.shape(one["refit"]["each"]) == (2, 2)


def test_files_are_joined(runs: Path) -> None:
    """The methods are those of both files, now compared; a method cannot be there twice."""
    out = {name: runs.parent / f"{name}.png" for name in ("a", "b", "joined")}
    one, other = (drawn(out[n], "imitation", f"runs={runs}/{n}", "refit=0") for n in ("a", "b"))
    files = [out[name].with_suffix(".json") for name in ("a", "b")]
    joined = drawn(out["joined"], "imitation", f"runs={files[0]},{files[1]}")
    assert joined["methods"] == one["methods"] | other["methods"]
    assert (set(one["comparisons"]), set(joined["comparisons"])) == (set(), {"behaviour cloning"})
    assert code("imitation", f"runs={files[0]},{files[0]}", f"out={out['joined']}") == 2
