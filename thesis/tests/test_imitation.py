"""The study of clones that query their teacher."""

import json
from pathlib import Path
from typing import Any

import jax
import numpy as np
import pytest
from tiny import call, only_line

from hybrid_rl import figures, train
from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.cli import command
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
    *("checkpoint_every=80", "log_every=20", "compile_cache=null"),
]


def draw(*arguments: str) -> int:
    """Exit code of the command."""
    return call(lambda: command.run(figures.main), "study=imitation", *arguments)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of two runs."""
    folder = tmp_path_factory.mktemp("queries")
    for name, *more in (("b", "algo=rq_dagger"), ("a", "algo=dagger", "taught.decisions=[80]")):
        train.train(config.load([*SHORT, *more, f"run_dir={folder / name}"]))
    return folder


def test_shares_are_those_of_the_teacher(runs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Scores in the log, over those of the teacher from the same first states."""
    out = runs.parent / "shares.png"
    assert draw(f"runs={runs}/*", "refit=4", "at=0,2", f"out={out}") == 0
    numbers = json.loads(out.with_suffix(".json").read_text())
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
        rows = [row for row in RunFolder(runs / folder).rows if name in row]
        for seed in (0, 1):
            logged = [row[name] for row in rows if row["seed"] == seed]
            shares = np.array(one["each"][seed])
            np.testing.assert_allclose(shares * numbers["teacher"], logged, rtol=1e-3)
        assert one["refit"]["N"] == [0, 2]
        assert np.shape(one["refit"]["each"]) == (2, 2)
    assert "RQ-DAgger, refit: N=2" in capsys.readouterr().out


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


def test_files_are_joined(runs: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """The numbers are those of one file of all runs; a method cannot be there twice."""
    files = [runs.parent / f"{name}.json" for name in ("a", "b", "ab", "joined")]
    one, other, both, joined = (file.with_suffix(".png") for file in files)
    assert draw(f"runs={runs}/a", "refit=0", f"out={one}") == 0
    assert draw(f"runs={runs}/b", "refit=0", f"out={other}") == 0
    assert draw(f"runs={runs}/*", "refit=0", f"out={both}") == 0
    assert draw(f"runs={files[0]},{files[1]}", f"out={joined}") == 0
    assert json.loads(files[2].read_text()) == json.loads(files[3].read_text())
    capfd.readouterr()
    assert draw(f"runs={files[0]},{files[0]}", f"out={joined}") == 2
    assert "behaviour cloning is in another file, too" in only_line(capfd)


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["at=9"], "at=9: "),
        (["at=x"], "at=x: must be whole numbers"),
        (["runs=nowhere/*"], "runs=nowhere/*: no run there"),
    ],
)
def test_bad_usage_is_one_line(
    runs: Path, arguments: list[str], line: str, capfd: pytest.CaptureFixture[str]
) -> None:
    """Exit code 2."""
    given = arguments if arguments[0].startswith("runs") else [f"runs={runs}/*", *arguments]
    assert draw(*given, "refit=1", f"out={runs.parent / 'bad.png'}") == 2
    assert line in only_line(capfd)


def test_a_run_without_a_teacher_is_refused(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """The line names the methods that have one."""
    short = [each for each in SHORT if "dagger" not in each]
    train.train(
        config.load(
            [*short, "algo=sac", "policy_learner.batch_size=4", f"run_dir={tmp_path / 'a'}"]
        )
    )
    assert draw(f"runs={tmp_path}/*") == 2
    assert "needs algo=dagger or its kin" in only_line(capfd)
