"""The command that records an expert, and training on what it wrote."""

import json
from pathlib import Path

import numpy as np
import pytest
from tiny import TINY, call_command, call_train, finished, refusal, run
from tiny import demonstrate as recorded

from hybrid_rl import demonstrate, evaluate, train
from hybrid_rl.constraints.effort import Effort
from hybrid_rl.data.demonstrations import load
from hybrid_rl.envs.experts.push import PushController
from hybrid_rl.envs.sawyer_push import SawyerPush
from hybrid_rl.run.saved import load as load_run
from hybrid_rl.settings import build as config
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Params

pytestmark = pytest.mark.turns(3)


# A run of two seeds whose episodes take 40 decisions.
trained = finished("algo=sac", "episode.steps=40", "num_seeds=2")


def test_a_hand_made_expert_is_recorded_as_it_acted():
    """Decisions follow each other, rewards add up, and a push that ends has succeeded."""
    limited = Episode(SawyerPush("native"), 100, constraint=Effort(0.1))
    result = demonstrate.record(limited, PushController(), Params(), episodes=3, seed=5)
    rows, episode = result.decisions, result.episode
    within = np.flatnonzero(episode[1:] == episode[:-1])
    np.testing.assert_array_equal(rows.next_obs[within], rows.obs[within + 1])
    totals = [rows.reward[episode == i].sum() for i in range(3)]
    np.testing.assert_allclose(result.returns, totals, rtol=1e-5)
    ends = np.flatnonzero(np.diff(episode, append=3))
    np.testing.assert_array_equal(rows.terminated[ends], result.success > 0)
    np.testing.assert_array_equal(rows.terminated.sum() + rows.truncated.sum(), 3)
    assert result.success.sum() >= 2
    assert (np.bincount(episode) <= 100).all()


def test_a_run_is_recorded_the_same_twice_and_learned_from(trained, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for out in ("", "out=again.npz"):
        line = [f"run={trained}", "mode=policy", "episodes=3", "seed=7", *([out] if out else [])]
        assert call_command(demonstrate.main, *line) == 0
    assert "pendulum.npz: 3 episodes, 120 decisions, seed 7, return -" in capsys.readouterr().out
    one, two = load("demonstrations/pendulum.npz"), load("again.npz")
    assert all(np.array_equal(one[name], two[name]) for name in one)
    assert (one["truncated"].nonzero()[0] == [39, 79, 119]).all()
    line = [*TINY, "algo=hybrid_bc", "total_steps=100", "pretrain=2", "num_demonstrations=2"]
    assert call_train(*line, "cloning_learner.batch_size=16", "run_dir=learned") == 0
    rows = [json.loads(row) for row in Path("learned/metrics.jsonl").read_text().splitlines()]
    assert {"bc/policy_loss", "model/loss"} <= {name for row in rows for name in row}
    capacity = config.build(config.load(line)).agent.replay.capacity
    assert capacity == 2 * 40 + 100  # neither demonstrations nor experience are forgotten


def test_the_task_is_changed_as_in_training(tmp_path, capsys):
    out = tmp_path / "short.npz"
    line = ["task=sawyer_push", "episodes=1", "episode.steps=3", "env.speed=0.05", f"out={out}"]
    assert call_command(demonstrate.main, *line) == 0
    result = load(out)
    assert len(result["reward"]) == 3
    moved = np.linalg.norm(np.diff(result["obs"][:, :2] / 10, axis=0), axis=1)
    assert (moved < 0.05 * np.sqrt(2) * 0.1).all()  # [m] in a decision
    for wrong in ("env.sped=1", "planner.samples=3"):
        assert call_command(demonstrate.main, *line, wrong) == 2
    printed = capsys.readouterr().err
    assert "env.sped: task=sawyer_push has no such key" in printed
    assert "planner.samples=3: unknown argument; give KEY=VALUE with task" in printed


def test_a_task_of_ones_own_has_an_expert_too(tmp_path):
    (tmp_path / "task").mkdir()
    (tmp_path / "task" / "mine.yaml").write_text(
        "# @package _global_\ndefaults: [/task@_global_: pendulum, _self_]\ntask: mine\n"
    )
    line = [f"config_dir={tmp_path}", "task=mine", "expert=babble", f"out={tmp_path / 'x.npz'}"]
    assert call_command(demonstrate.main, *line, "episode.steps=3", "episodes=1") == 0
    assert load(tmp_path / "x.npz")["task"] == "mine"


def test_what_was_learned_outlives_its_demonstrations(tmp_path, capfd):
    """To evaluate needs the learned policy alone; to go on learning needs the file."""
    demonstrations = recorded(tmp_path, config.load(["task=pendulum"]))
    folder, file = tmp_path / "run", Path(demonstrations.partition("=")[2])
    few = ["total_steps=20", "checkpoint_every=20", "episode.steps=5", "pretrain=2"]
    run(folder, "algo=bc", demonstrations, *few, "random_steps=0")
    before = evaluate.evaluate(load_run(folder), "policy", 2)["return"]
    file.unlink()
    after = evaluate.evaluate(load_run(folder), "policy", 2)["return"]
    np.testing.assert_array_equal(after, before)
    assert f"{file}: no such file" in refusal(capfd, f"resume={folder}", "total_steps=40")


def test_a_regulator_of_recordings_outlives_them(tmp_path):
    """The model that it learned from them is in the checkpoint, where studies find it, too."""
    task, file = "task=van_der_pol", tmp_path / "babble.npz"
    given = [task, "expert=babble", "episodes=2", "episode.steps=30", f"out={file}"]
    assert call_command(demonstrate.main, *given) == 0
    folder = tmp_path / "run"
    few = ["total_steps=4", "checkpoint_every=4", "episode.steps=2", "compile_cache=null"]
    given = [task, "algo=koopman_known", f"demonstrations={file}", f"run_dir={folder}", *few]
    train.train(config.load(given))
    before = evaluate.evaluate(load_run(folder), "full", 2)["return"]
    file.unlink()
    after = evaluate.evaluate(load_run(folder, "runs"), "full", 2)["return"]
    np.testing.assert_array_equal(after, before)


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ("expert=regulator", "task=quadcopter: its expert needs an analytic environment; `python"),
        (
            "expert=babble expert.controller.action=[0.4]",
            "expert.controller.action=[0.4]: must be a number",
        ),
    ],
)
def test_an_expert_that_does_not_fit_is_named(given, line, tmp_path, capfd):
    out = tmp_path / "none.npz"
    main = [*given.split(), "task=quadcopter", "episodes=1", f"out={out}"]
    assert line in refusal(capfd, *main, of=demonstrate.main)
    assert not out.exists()
