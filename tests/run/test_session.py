"""A run is stopped anywhere, its learners diverge alone, its numbers are what their names say."""

import shlex
import signal
import time

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tiny import TINY, call_train, finished, refusal, rows_of, run, summary_of

from hybrid_rl.errors import DivergenceError
from hybrid_rl.run import schedule, session
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.evaluations import Evaluations
from hybrid_rl.run.folder import read
from hybrid_rl.run.logs import records
from hybrid_rl.run.saved import build_run, restore
from hybrid_rl.run.schedule import Pace, Schedule, Speed
from hybrid_rl.run.session import Session
from hybrid_rl.settings.words import quoted
from scripts import interrupt

SAC = ["algo=sac", "num_seeds=2"]


whole = finished(*SAC)  # a run of two learners that was never stopped


def when(patch, step, then):
    """`then` gets the session after the first call that reaches `step`, and after those beyond."""
    advance = Session._advance

    def advanced(self):
        advance(self)
        if self.step >= step:
            then(self)

    patch.setattr(Session, "_advance", advanced)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP])
def test_a_program_that_trains_hears_the_signal_after_the_checkpoint(monkeypatch, tmp_path, number):
    """As though nothing had come between: a script ends, and no loop starts its next run."""
    folder, heard = tmp_path / "run", []

    def pressed(session):
        if session.stop is None:
            signal.raise_signal(number)
        while session.stop is None:
            time.sleep(0.001)

    def handler(*_):
        heard.append(checkpoint.steps(folder / "checkpoints")[-1])
        raise KeyboardInterrupt

    when(monkeypatch, 150, pressed)
    before = signal.signal(number, handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            run(folder, *SAC)
        assert signal.getsignal(number) is handler
    finally:
        signal.signal(number, before)
    assert heard == [summary_of(folder)["total_steps"]]
    assert summary_of(folder)["signal"] == number
    assert not (folder / "lock").exists()


def test_a_call_takes_about_a_second_and_a_half_whatever_the_speed():
    for each in (1e-5, 0.01, 0.4, 9.0):  # [s] a round
        pace_, took = Pace(), []
        for _ in range(20):
            rounds = pace_.rounds(10**6)
            took.append(rounds * each)
            pace_.took(rounds, rounds * each)
        assert max(took) <= max(schedule.CALL, each) + 1e-9
        assert took[-1] >= min(max(schedule.CALL - each, each), 10**6 * each)


def test_a_call_ends_at_marks_and_where_decisions_change():
    plan = Schedule(1000, 500, 300, 1, 1000)
    assert [plan.until(step, {120, 0}) for step in (0, 120, 299, 300, 990)] == [
        *(120, 300, 300, 500, 1000),
    ]
    assert not plan.row_due(120, 1)
    assert [plan.row_due(step, 7) for step in (301, 308, 504, 994, 1001)] == [
        *(True, False, True, False, True),
    ]


def test_sums_in_parts_are_the_sums_as_one():
    values = np.random.default_rng(0).normal(size=(50, 3)).astype(np.float32)
    values[3:20, 1], values[:, 2] = np.nan, np.nan
    whole, got = records.added({}, {"b": values}), {}
    for cut in np.split(values, [7, 8, 31]):
        got = records.added(got, {"b": cut, "a": -cut, "episode/done": cut})
    assert list(got) == ["b", "a"]
    assert got["b"].tobytes() == whole["b"].tobytes()
    rows = records.means(got, 3, 50)
    np.testing.assert_allclose([row["b"] for row in rows[:2]], np.nanmean(values[:, :2], 0), 1e-6)
    assert rows[2] == {"step": 50, "learner": 2}


def test_a_run_stopped_anywhere_goes_on_bit_for_bit(whole, tmp_path, monkeypatch, capsys):
    """Between marks, before an evaluation is made, and before the last one is.

    The name of the folder means something to the shell, to Hydra, to Orbax and to glob.
    """
    monkeypatch.setattr(Pace, "rounds", lambda self, left: min(left, 7))  # so a call ends there
    folder, line = tmp_path / "it's hidden=[8,8]", []
    begin = [*TINY, *SAC, f"run_dir={quoted(str(folder))}"]
    for step in (123, 300, 600):
        with pytest.MonkeyPatch.context() as patch:
            when(patch, step, lambda session: session.ask(signal.SIGTERM))
            assert call_train(*(line or begin)) == 128 + signal.SIGTERM
        printed = capsys.readouterr().out.splitlines()[-1]
        result, line = summary_of(folder), shlex.split(printed)[4:]
        assert printed.startswith("continue: python -m hybrid_rl.train ")
        assert step <= result["total_steps"] < step + 7
        assert not result["finished"]
    assert call_train(*line) == 0
    assert interrupt.difference(folder, whole) == ""
    assert summary_of(folder)["finished"]
    assert summary_of(folder)["final_eval"] == summary_of(whole)["final_eval"]


def break_learner(patch, number, step):
    """From `step` on the critic of a learner is no number."""
    advance = Session._advance

    def spoilt(x):
        return x.at[number].set(jnp.nan) if jnp.issubdtype(x.dtype, jnp.floating) else x

    def broken(self):
        if self.step == step:
            learners = self.state.learners
            with jax.debug_nans(False):
                policy = jax.tree.map(spoilt, learners["policy"])
            self.state = self.state.replace(learners=learners | {"policy": policy})
        advance(self)

    patch.setattr(Session, "_advance", broken)


def finite(folder):
    """Whether the learners of the newest checkpoint are."""
    step, state, _ = restore(folder, build_run(read(folder, "run")))
    learners = jax.tree.leaves(state.learners)
    newest = step == checkpoint.steps(folder / "checkpoints")[-1]
    return newest and all(np.isfinite(leaf).all() for leaf in learners)


def test_one_learner_diverges_and_the_other_goes_on(whole, tmp_path, capfd):
    folder = tmp_path / "run"
    with pytest.MonkeyPatch.context() as patch:
        break_learner(patch, 1, 250)
        found = run(folder, *SAC)
    (end,) = found["diverged"]
    assert end == {"seed": 1, "step": 251, "quantity": end["quantity"]}
    assert f"seed 1, step 251: {end['quantity']} is not finite" in capfd.readouterr().out
    assert (found["finished"], found["final_eval"][1], found["final_return"][1]) == (
        *(True, None, None),
    )
    mine = [row for row in rows_of(folder) if row["seed"] == 1]
    assert mine[-1].keys() == {"step", "seed", "wall_s", "diverged"}
    assert mine[-1]["diverged"] == end["quantity"]
    assert [row["step"] for row in mine if "world/reward" in row] == list(range(50, 251, 50))
    others = [[row for row in interrupt.rows(f) if row["seed"] == 0] for f in (folder, whole)]
    assert others[0] == others[1]
    assert finite(folder)
    line = refusal(capfd, f"resume={folder}", "total_steps=700", code=1)  # and it stays out
    assert line.startswith(f"hybrid_rl: seed 1, step 251: {end['quantity']} is not finite; the")
    assert {row["seed"] for row in rows_of(folder) if row["step"] > 251} == {0}
    assert rows_of(folder)[-1]["step"] == 700
    assert finite(folder)


def test_an_evaluation_that_is_not_finite_ends_the_learner(tmp_path):
    folder = tmp_path / "run"
    call = Evaluations.__call__
    with pytest.MonkeyPatch.context() as patch:
        bad = {"eval/return": float("nan")}
        patch.setattr(Evaluations, "__call__", lambda *given: [r | bad for r in call(*given)])
        with pytest.raises(DivergenceError) as error:
            run(folder, "algo=sac")
    values = str(error.value)
    assert values == (
        "seed 0, step 300: eval/return is not finite; checkpoint 200 is intact: fix what fails and "
        "resume it, or begin again with a lower learning rate"
    )
    assert checkpoint.steps(folder / "checkpoints") == [100, 200]
    assert checkpoint.verify(folder / "checkpoints" / "200") is None
    assert rows_of(folder)[-1]["diverged"] == "eval/return"
    summary = summary_of(folder)
    assert (summary["finished"], summary["diverged"][0]["step"]) == (False, 300)


def test_a_learner_without_a_checkpoint_goes_back_to_its_first_state(tmp_path):
    folder = tmp_path / "run"
    with pytest.MonkeyPatch.context() as patch:
        break_learner(patch, 0, 50)
        found = run(folder, *SAC, "checkpoint_replay=false", "total_steps=100")
    assert [end["seed"] for end in found["diverged"]] == [0]
    assert finite(folder)


def test_the_speed_is_that_of_learning(whole):
    """Half of the first decisions are random, then the batch fills: no speed before."""
    found = [row for row in rows_of(whole) if "world/reward" in row]
    assert [r["step"] for r in found if "perf/env_steps_per_s" not in r] == [50, 50]
    assert summary_of(whole)["env_steps_per_s"] > 0
    speed = Speed()
    assert speed.rate is None
    speed.add(100, 2.0)
    speed.add(50, 1.0)
    assert speed.rate == 50


def test_with_debug_nans_a_run_ends_in_the_call_that_made_one_and_not_before(tmp_path, monkeypatch):
    """Metrics that do not apply are NaN, too; here no metric tells what was learned."""
    monkeypatch.setattr(session.records, "infinite", lambda *_: {})
    break_learner(monkeypatch, 0, 200)
    break_learner(monkeypatch, 1, 200)
    with jax.debug_nans(True), pytest.raises(DivergenceError, match="seed 0, step 250: "):
        run(tmp_path / "run", *SAC)
