"""A sweep that searches: the study with a function in place of runs, then real runs."""

import json

import pytest
from hydra.core.override_parser.overrides_parser import OverridesParser
from tiny import TINY, call_train, only_line

from hybrid_rl.errors import UsageError
from hybrid_rl.tools.tuner import study, tuning

TUNED = ["-m", "hydra/sweeper=tuned", *TINY, "algo=sac"]
SPACE = [
    "a=choice(1,10)",
    "b=tag(log,interval(1e-4,1e-1))",
    "c=int(interval(0,8))",
    "d=range(1,4)",
]


def space(*given):
    parsed = OverridesParser.create().parse_overrides(list(given or SPACE))
    return {each.key_or_group: study.distribution(each) for each in parsed}


def settings(trials, **given):
    kept = {"seed": 0, "startup": 3, "prune": True, "metric": "final_eval"}
    return study.Settings(trials=trials, **(kept | given))


def search(folder, plan, stop=None, given=()):
    """Trials whose evaluations at 100, 200, 300 are made of c; stop: dies in this trial's midst."""
    with study.open_study(folder, plan, space(*given), ["x=1"], 100) as opened:
        for count in range(100):
            if not opened.open:
                return opened.numbers()
            trial = opened.ask()
            if opened.known(trial):
                continue
            watch = study.Watch(trial, plan.metric, seeds=2, steps=300)
            for step in (100, 200, 300):
                row = {"step": step, "eval/return": peak(trial.params)}
                assert watch(row | {"seed": 0}) is None  # until every seed has it
                if stop == count:
                    return None
                row["eval/return"] += 2.0
                if watch(row | {"seed": 1}) is False:
                    break
            opened.tell(trial, 0, "", watch.pruned)
    raise AssertionError("the study has no end")


def peak(values):
    """Best at c = 6."""
    return -abs(values["c"] - 6.0)


def test_the_search_finds_the_peak_and_prunes_what_is_below_the_median(tmp_path):
    found = search(tmp_path, settings(16))
    rows = found["trials"]
    assert [row["trial"] for row in rows] == list(range(16))
    best = rows[found["best"]]
    assert abs(best["values"]["c"] - 6) <= 1
    assert best["result"] == peak(best["values"]) + 1.0  # the mean of both seeds
    pruned = [row for row in rows if row["state"] == "pruned"]
    assert pruned
    assert {row["step"] for row in pruned} == {200}  # not at the first evaluation
    assert min(row["trial"] for row in pruned) >= 3
    done = [row["result"] for row in rows if row["state"] == "complete"]
    assert max(row["result"] for row in pruned) < max(done)
    assert max(found["importances"], key=found["importances"].get) == "c"
    assert all(row["values"]["a"] in ("1", "10") for row in rows)
    assert all(1e-4 <= row["values"]["b"] <= 1e-1 for row in rows)


def test_nothing_is_pruned_without_prune(tmp_path):
    rows = search(tmp_path, settings(6, prune=False))["trials"]
    assert {row["state"] for row in rows} == {"complete"}


def test_a_study_that_was_killed_finds_what_it_would_have_found(tmp_path):
    """Its trial comes again with its values, its evaluations and its run folder."""
    plan = settings(7)
    (tmp_path / "whole").mkdir()
    (tmp_path / "killed").mkdir()
    whole = search(tmp_path / "whole", plan)
    assert search(tmp_path / "killed", plan, stop=4) is None
    again = search(tmp_path / "killed", plan)
    same = ("values", "state", "result", "step")
    assert [[row[k] for k in same] for row in again["trials"]] == [
        [row[k] for k in same] for row in whole["trials"]
    ]
    assert [(row["trial"], row["run"]) for row in again["trials"]][3:6] == [
        (3, "3"),
        (4, "4"),
        (5, "6"),
    ]


def test_values_that_were_tried_are_not_run_again(tmp_path):
    rows = search(tmp_path, settings(8), given=["c=int(interval(5,6))"])["trials"]
    assert len(rows) == 8
    assert len({row["run"] for row in rows}) == 2
    assert sum(row["line"].startswith("as trial ") for row in rows) == 6


def test_a_folder_holds_one_study(tmp_path):
    search(tmp_path, settings(1))
    other = study.open_study(tmp_path, settings(2), space(), ["x=2"], 100)
    with pytest.raises(UsageError, match="holds a study with x=1"), other:
        pass
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / study.FILE).write_text("no database, but a text\n" * 100)
    with pytest.raises(UsageError, match="is no study of Optuna"):
        search(tmp_path / "other", settings(1))


def test_a_metric_that_is_not_evaluated_is_named(tmp_path):
    with pytest.raises(UsageError, match="metric=eval/success: the evaluations have eval/return"):
        search(tmp_path, settings(1, metric="eval/success"))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("hydra.sweeper.trials=0", "hydra.sweeper.trials=0: must be a whole number, 1 or more"),
        ("hydra.sweeper.metric=loss", "must be final_eval or begin with eval/"),
        ("seed=0", "no key has several values; write KEY=choice(A,B)"),
        ("algo=interval(0,1)", "algo=interval(0,1): has names, such as algo=choice("),
        ("policy_learner.tau=interval(0.1,3)", ": must lie in (0, 1]"),
        ("policy_learner.tau=tag(log,interval(0,0.1))", "`low > 0` must hold"),
        ("seed=0,1 eval_modes=[]", "eval_modes=[]: a study needs evaluations"),
        ("seed=0,1 resume=x", "resume=x: not in a study"),
        ("run_dir=x,y", "run_dir=x,y: a study has one folder"),
        ("seed=0,1 hydra/launcher=submitit_local", "leave hydra/launcher out"),
    ],
)
def test_what_cannot_run_is_found_before_the_first_trial(
    tmp_path, monkeypatch, capfd, given, words
):
    monkeypatch.chdir(tmp_path)
    assert call_train(*TUNED, *given.split()) == 2
    assert words in only_line(capfd)
    assert list(tmp_path.iterdir()) == []


def test_without_optuna_it_is_one_line(monkeypatch, capfd):
    monkeypatch.setitem(__import__("sys").modules, "optuna", None)
    assert call_train(*TUNED, "seed=0,1") == 2
    assert 'Optuna is not installed; pip install "hybrid_rl[tune]"' in only_line(capfd)


@pytest.mark.turns(2)
def test_three_real_trials_their_table_and_their_picture(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    short = ["total_steps=300", "eval_every=100", "checkpoint_every=300", "num_seeds=2"]
    rates = "policy_learner.policy_learning_rate=choice(1e-4,1e30)"
    line = [*TUNED, *short, rates, "run_dir=study", "hydra.sweeper.startup=1"]
    code = call_train(*line, "hydra.sweeper.trials=3")
    out, err = capfd.readouterr()
    assert code in (0, 1), err
    numbers = json.loads((tmp_path / "study" / "trials.json").read_text())
    states = [row["state"] for row in numbers["trials"]]
    assert len(states) == 3
    assert "complete" in states
    assert code == (1 if "fail" in states else 0), err
    assert f"3 of 3 trials: {states.count('complete')} done" in out
    for row in numbers["trials"]:
        assert row["line"] in out
        if row["state"] == "complete":
            summary = (tmp_path / "study" / row["run"] / "summary.json").read_text()
            assert sum(json.loads(summary)["final_eval"]) / 2 == pytest.approx(row["result"])
    assert (tmp_path / "study" / "trials.png").stat().st_size > 1000
    drawn, again = tuning.figure(str(tmp_path / "study"))
    assert again == numbers
    assert len(drawn.axes) == 2
    assert call_train(*line, "hydra.sweeper.trials=3") == 0  # nothing is left to do
    assert "3 of 3 trials" in capfd.readouterr().out


@pytest.mark.filterwarnings("error")
def test_a_study_whose_trials_all_failed_has_a_picture():
    lost = {"trial": 0, "values": {"a": "1"}, "state": "fail", "result": None, "run": "0"}
    found = {"metric": "final_eval", "keys": {"a": "names"}, "trials": [lost], "best": None}
    assert tuning.draw({**found, "importances": {}}).axes
