"""What the commands leave behind: files, names, tables, pictures."""

import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import jax
import numpy as np
import pytest
from omegaconf import OmegaConf
from tiny import TINY, call_command, call_train, contents, rows_of, summary_of

from hybrid_rl import evaluate
from hybrid_rl.envs.mujoco.native import cores
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.saved import build_run, load, restore
from hybrid_rl.training.rollout import evaluation_keys

pytestmark = pytest.mark.turns(3)

MODES = {"full": "eval/return", "policy": "eval/policy_return", "planner": "eval/planner_return"}
NAME = re.compile(r"(train|eval|model|sac|planner|perf|world)/[a-z_]+")


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    """A run of the command, on MuJoCo C."""
    folder = tmp_path_factory.mktemp("trained") / "run"
    world = ["task=cartpole", "physics=native", "episode.steps=40"]
    method = ["algo=hybrid_stochastic", "learning=replay"]
    settings = [*TINY, *world, *method, "eval_modes=[full,policy,planner]", f"run_dir={folder}"]
    assert call_train(*settings) == 0
    return folder


def test_a_run_folder_holds_what_it_should(trained):
    result = {path.name for path in trained.iterdir() if not path.name.startswith("evaluation_")}
    assert result == {"config.yaml", "metrics.jsonl", "tensorboard", "checkpoints", "summary.json"}
    assert checkpoint.steps(trained / "checkpoints") == [500, 600]


def test_rows_have_coordinates_and_the_documented_names(trained):
    rows = rows_of(trained)
    steps, found = [row["step"] for row in rows], {name for row in rows for name in row}
    assert steps == sorted(steps)
    for row in rows:
        assert (type(row["step"]), row["seed"], type(row["wall_s"])) == (int, 0, float)
        names = row.keys() - {"step", "seed", "wall_s"}
        assert names
        assert all(NAME.fullmatch(name) for name in names)
        assert np.isfinite([row[name] for name in names]).all()
    assert found >= {*MODES.values(), "train/return", "train/length", "model/loss", "sac/q"}
    assert found >= {"model/reward_loss", "perf/env_steps_per_s", "planner/effective_samples"}
    ends = [row for row in rows if "train/return" in row]
    assert [row["step"] for row in ends] == [*range(40, 601, 40)]
    assert {row["train/length"] for row in ends} == {40}


def test_the_summary_describes_the_run(trained):
    values = summary_of(trained)
    assert values.keys() >= {
        *("task", "algo", "seeds", "total_steps", "finished", "final_return", "wall_s"),
        *("env_steps_per_s", "physics", "device", "versions", "git_commit"),
    }
    named = values["task"], values["algo"], values["seeds"]
    assert named == ("cartpole", "hybrid_stochastic", [0])
    assert (values["total_steps"], values["finished"], values["physics"]) == (600, True, "native")
    last = [row["train/return"] for row in rows_of(trained) if row["step"] > 540 and len(row) == 5]
    assert values["final_return"] == [pytest.approx(np.mean(last))]
    assert 0 < values["compile_s"] < values["wall_s"]
    assert values["before_s"] > 0
    assert {"jax", "mujoco", "python", "hybrid_rl"} <= values["versions"].keys()


@pytest.mark.parametrize("mode", MODES)
def test_evaluate_repeats_what_training_measured_last(trained, capsys, mode):
    code = call_command(evaluate.main, f"run={trained}", "episodes=1", f"mode={mode}")
    assert code == 0
    values = json.loads((trained / f"evaluation_{mode}.json").read_text())
    named = [values[key] for key in ("mode", "step", "seeds", "episodes")]
    assert named == [mode, 600, [0], 1]
    assert values["mean"] == [row[0] for row in values["returns"]]
    last = [row[MODES[mode]] for row in rows_of(trained) if MODES[mode] in row][-1]
    assert values["mean"] == [pytest.approx(last, rel=1e-4)]
    table = capsys.readouterr().out
    assert f"mode {mode}, step 600" in " ".join(table.split())
    assert f"{last:,.1f}" in table


def test_evaluate_in_another_world(trained, capsys):
    """A pole of which the policy sees little, and actions that arrive late."""
    changes = ("episode.sensor_noise=3.0", "episode.delay=1")
    main = partial(call_command, evaluate.main)
    assert main(f"run={trained}", "episodes=3", "mode=policy", *changes) == 0
    assert f"step 600, {', '.join(changes)}" in capsys.readouterr().out
    name = "evaluation_policy_episode.sensor_noise=3.0_episode.delay=1.json"
    values = json.loads((trained / name).read_text())
    assert values["changes"] == dict(change.split("=") for change in changes)
    made: list[int] = []
    plain = evaluate.evaluate(load(trained), "policy", 3, made.append)["return"]
    assert made == sorted(set(made))
    assert made[0] == 0 < made[-1] < load(trained).episode.steps
    assert not np.isclose(values["returns"], plain, rtol=1e-4).any()


def test_a_part_of_a_checkpoint_is_restored_alone(trained):
    """The memory of every decision, without what was learned from it; and the other way round."""
    made = build_run(run_folder.read(trained, "run"))
    step, state, notes = restore(trained, made, "memory")
    assert (step, notes, state.memory.count.tolist()) == (600, [], [600])
    assert state.env is state.control is state.learners is state.key is None
    state = restore(trained, made)[1]
    assert state.memory is None
    assert sorted(state.learners) == sorted(made.agent.learners)


def test_a_trained_policy_gets_what_the_evaluation_says(trained):
    """Driven from Python, one observation at a time; nothing is written."""
    before, result = contents(trained), load(str(trained))
    expected = evaluate.evaluate(result, "policy", 1)["return"][0, 0]
    episode, policy = result.episode, result.policy(mode="policy")
    state = episode.reset(jax.random.split(evaluation_keys(0, 1)[0])[0])
    step = jax.jit(episode.step)
    policy.reset()
    while not state.done:
        state = step(state, policy(np.asarray(state.obs)))
    assert float(state.clock.total) == pytest.approx(float(expected), rel=1e-3)
    planned = result.policy()(np.asarray(state.obs))
    assert planned.shape == (1,)
    assert np.abs(planned).max() <= 1
    assert contents(trained) == before


def test_runs_that_begin_at_once_do_not_trip_over_each_other(tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    config = OmegaConf.create({"task": "pendulum", "algo": "sac"})
    with ThreadPoolExecutor(16) as pool:
        made = list(pool.map(lambda _: run_folder.new_folder(config), range(300)))
    assert len(set(made)) == 300
    assert {*made} == {*Path("runs/pendulum/sac").iterdir()}


@pytest.mark.parametrize(("given", "threads"), [({}, max(8, cores())), ({"NPROC": "3"}, 3)])
def test_mjx_has_threads_enough_not_to_wait_for_itself(given, threads) -> None:
    code = (
        "import jax; from pathlib import Path; from types import SimpleNamespace\n"
        "from hybrid_rl.run.machine.jax_settings import prepare\n"
        "prepare(SimpleNamespace(physics='mjx', precision='float32', compile_cache=None))\n"
        "jax.devices()\n"
        "names = [path.read_text() for path in Path('/proc/self/task').glob('*/comm')]\n"
        "print(sum('XLAEigen' in name for name in names))"
    )
    env = {name: text for name, text in os.environ.items() if name != "NPROC"} | given
    done = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) == threads
