"""From Python: the page's code, runs by names and by parts, plans, curves as tables."""

import json
import re
import signal
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from programs import shared
from tiny import TINY, contents, summary_of

import hybrid_rl as hr
from hybrid_rl.analysis.curves import Curve
from hybrid_rl.api import Result, run_of
from hybrid_rl.run.launch import Output
from hybrid_rl.run.session import Session

pytestmark = pytest.mark.turns(3)

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGE = (ROOT / "docs/python.md").read_text(encoding="utf-8")
SIZES = {"total_steps": 200, "random_steps": 20, "eval_every": 100}


def test_the_page_and_the_readme_run(tmp_path, monkeypatch):
    """With their sizes reduced. The planners reach their goal; the function ends the first run."""
    monkeypatch.chdir(tmp_path)
    code = "\n".join(re.findall(r"```python\n(.*?)```", README + PAGE, re.DOTALL))
    for key, size in SIZES.items():
        code = re.sub(rf"({key}=)\d+", rf"\g<1>{size}", code)
    code = code.replace("< 2000", "< 100").replace("(64, 64)", "(8, 8)").replace("print(x)", "end")
    code = re.sub(r"^end.*", "ends.append(x)", code, flags=re.MULTILINE)
    names = {"ends": []}
    with shared():
        exec(code, names)
    np.testing.assert_allclose(names["ends"], [[1, 0], [1, 0]], atol=0.1)
    assert (tmp_path / "runs/rail/summary.json").exists()
    assert names["result"]["seeds"] == [0, 1, 2, 3, 4]
    mass = np.asarray(names["paths"])[..., :2]
    near = [np.linalg.norm(mass - hill, axis=-1) < 0.2 for hill in (0.3, 0.7)]  # hills
    assert [share.mean() > 0.3 for share in near] == [True, True]  # without the gradient 0.02
    least = np.linalg.lstsq(names["s"], names["after"])[0].T
    np.testing.assert_allclose(names["K"], least, atol=1e-3)
    x = np.array([0.5, 0.0])
    for _ in range(200):
        x = names["swing"](names["theta"], x, -names["regulator"] @ names["z"](x))
    np.testing.assert_allclose(x, 0, atol=0.01)  # without it the pendulum falls
    rates = np.asarray(names["path"].x[:-1, 1])
    np.testing.assert_allclose(names["F"][:, 1, 1], -0.05 * rates, rtol=1e-4)
    assert names["value"] > 0


def run(folder, *more, **options):
    with shared():
        return hr.train([*TINY, "algo=sac", f"run_dir={folder}", *more], **options)


def test_a_function_gets_the_rows_of_the_file_and_ends_a_run_that_can_be_resumed(tmp_path, capfd):
    rows, folder = [], tmp_path / "run"

    def until(row):
        rows.append(row)
        return row["step"] < 200

    half = run(folder, on_row=until, progress=False)
    assert (half["finished"], half["total_steps"], half["signal"]) == (False, 200, None)
    with shared():
        whole = hr.train([f"resume={folder}"], on_row=rows.append, progress=False)
    assert (whole["finished"], whole["total_steps"]) == (True, 600)
    lines = (folder / "metrics.jsonl").read_text().splitlines()
    steps = [(row["step"], row["seed"]) for row in map(json.loads, lines)]
    assert [(row["step"], row["seed"]) for row in rows] == steps
    assert capfd.readouterr().out == ""
    assert whole.folder == folder
    assert whole.curves("train/return")[0].x.tolist() == [200, 400, 600]
    assert whole.load().step == 600


def test_the_folder_of_a_result_holds_when_the_working_folder_changes(tmp_path, monkeypatch):
    (tmp_path / "there").mkdir()
    monkeypatch.chdir(tmp_path)
    result = Result({"run_dir": "runs/x"})
    monkeypatch.chdir("there")
    assert result.folder == tmp_path / "runs/x"


def test_an_exception_of_the_function_follows_the_checkpoint(tmp_path):
    def broken(row):
        raise ZeroDivisionError(row["step"])

    with pytest.raises(ZeroDivisionError):
        run(tmp_path / "run", on_row=broken, progress=False)
    saved = int(max((tmp_path / "run" / "checkpoints").iterdir()).name)
    assert summary_of(tmp_path / "run")["total_steps"] == saved < 600


def test_a_function_that_raised_is_not_called_again():
    asked, called = [], []

    def broken(row):
        called.append(row)
        raise ValueError

    function = Output(broken)
    function.ask = asked.append
    function({"step": 1})
    function({"step": 2})
    assert (asked, called) == ([0], [{"step": 1}])


def test_a_signal_stays_the_cause_of_the_end_where_the_function_asks_as_well():
    session = Mock(stop=None)
    for number in (0, signal.SIGINT, 0):
        Session.ask(session, number)
    assert session.stop == signal.SIGINT


@pytest.mark.parametrize(
    ("ask", "line"),
    [
        (lambda: hr.train(task="pendulum"), r'train\(\["task=pendulum", \.\.\.\]\)'),
        (lambda: hr.train("task=pendulum"), r"\"task=pendulum\": give a list, \['task=pendulum'\]"),
        (lambda: hr.train(Result, seed=0), "Result: give a list .* Gymnasium .* Agent"),
        (lambda: hr.load("pendulm"), r"load\('pendulm'\): no run folder, .* pendulum"),
    ],
)
def test_a_wrong_call_is_answered_in_one_line(ask, line):
    with pytest.raises(hr.UsageError, match=line) as caught:
        ask()
    assert "\n" not in str(caught.value)


def test_what_is_trained_from_parts_continues_and_is_read_back_by_the_same_agent_alone(tmp_path):
    agent = parts()
    folder = tmp_path / "mine"
    short = {"num_seeds": 2, "run_dir": folder, "progress": False}
    hr.train(agent, total_steps=60, **short)
    longer = hr.train(agent, total_steps=120, name="mine", **short)
    assert (longer["total_steps"], longer["finished"]) == (120, True)
    (curve,) = longer.curves("train/return")
    assert (curve.label, curve.seeds, curve.x.tolist()) == ("mine", (0, 1), [50, 100])
    policy = longer.load().policy(seed=1)
    assert policy([1.0, 0.0, 0.0]).shape == (1,)
    before = contents(folder)
    for ask, line in (
        (
            lambda: hr.train(agent, total_steps=120, run_dir=folder),
            "holds the learners of seed 0, 1",
        ),
        (lambda: hr.train(agent, total_steps=60, **short), "has 120 steps; total_steps=60"),
        (lambda: hr.train(agent, total_steps=0), "total_steps=0: must be a whole number"),
        (lambda: hr.train(agent, total_steps=60, seed=-1), "seed=-1: must be a whole number, 0"),
        (lambda: hr.load(folder), "trained from parts in Python"),
        (lambda: hr.train([f"resume={folder}"]), "trained from parts in Python"),
    ):
        with pytest.raises(hr.UsageError, match=line):
            ask()
    assert contents(folder) == before
    settings = {"total_steps": np.int64(180), "num_seeds": 2, "run_dir": folder}
    assert run_of(agent, **settings).notes == ()
    other = replace(agent, episode=replace(agent.episode, steps=40))
    (note,) = run_of(other, **settings).notes
    assert note == "goes on with another agent than before"


def test_a_world_of_an_agent_is_checked_before_it_trains(tmp_path):
    from hybrid_rl.envs.analytic.pendulum import Pendulum

    class Paid(Pendulum):
        def step(self, state, action):
            return super().step(state, action).replace(reward=np.zeros(1, np.float32))

    agent = parts()
    wrong = replace(agent, episode=replace(agent.episode, env=Paid()))
    with pytest.raises(hr.UsageError, match=r"Paid\.step: returned reward float32\[1\]"):
        hr.train(wrong, total_steps=60, run_dir=tmp_path / "mine")
    assert not (tmp_path / "mine").exists()
    with jax.enable_x64(True), pytest.raises(hr.UsageError, match="JAX_ENABLE_X64: is on"):
        hr.train(agent, total_steps=60, run_dir=tmp_path / "mine")
    with pytest.raises(hr.UsageError, match=r"Pendulum is a class; give Pendulum\(\)"):
        hr.check(Pendulum)


def parts():
    """SAC on the pendulum, in small."""
    from hybrid_rl.controllers.policy import PolicyController
    from hybrid_rl.critics.ensemble_q import EnsembleQ
    from hybrid_rl.data.replay import Replay
    from hybrid_rl.learners.sac import SAC
    from hybrid_rl.policies.tanh_gaussian import TanhGaussian

    policy, critic = TanhGaussian(hidden=(8,)), EnsembleQ(hidden=(8,))
    learners = {"policy": SAC(policy, critic, batch_size=4)}
    episode = hr.make("pendulum", ["episode.steps=50"])
    return hr.Agent(episode, PolicyController(policy), learners, Replay())


def test_both_plans_agree_under_vmap():
    """On the direction of the first action, from a state on either side of the goal."""

    def step(x, u):
        return x + 0.1 * u

    def reward(x, u, after):
        return -((after - 0.25) ** 2).sum()

    states, before = jnp.array([[0.0], [0.5]]), jnp.zeros((4, 1))
    keys = jax.random.split(jax.random.key(0), 2)
    for plan, more in ((hr.adjoint.plan, ()), (hr.sampling.plan, (keys,))):
        planned = jax.jit(jax.vmap(partial(plan, step, reward), (0, None, *(0 for _ in more))))
        actions = planned(states, before, *more)
        assert actions.shape == (2, 4, 1)
        assert (actions[0, 0] > 0.2).all()
        assert (actions[1, 0] < -0.2).all()


def test_a_curve_is_a_table_of_its_values(monkeypatch):
    """Of two seeds, one of which has a value less."""
    monkeypatch.setitem(sys.modules, "pandas", SimpleNamespace(DataFrame=dict))
    x, each = np.array([10.0, 20.0]), np.array([[1.0, 2.0], [3.0, np.nan]])
    table = Curve("t", "m", "l", (4, 5), ("a", "a"), x, each, *each[[0, 0, 0]], ()).frame()
    assert [table[name] for name in ("task", "label", "metric")] == ["t", "l", "m"]
    wanted = [[4, 4, 5], [10.0, 20.0, 10.0], [1.0, 2.0, 3.0]]
    assert [table[name].tolist() for name in ("seed", "x", "value")] == wanted


def test_the_rows_of_runs_are_a_table(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "pandas", SimpleNamespace(DataFrame=list))
    rows = [{"step": 4, "seed": 0, "wall_s": 1.0, "eval/return": 2.0}]
    rows.append({"step": 4, "seed": 1, "wall_s": 1.0, "model/loss": 3.0})
    (tmp_path / "metrics.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    assert hr.metrics(tmp_path) == [{"run": str(tmp_path), **row} for row in rows]
