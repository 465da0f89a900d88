"""Copies of the rows: a table of CSV, and runs of Weights & Biases without a network."""

import csv
import sys
from types import SimpleNamespace

import pytest
from tiny import call_train, only_line, rows_of

from hybrid_rl.errors import UsageError
from hybrid_rl.run.logs import loggers
from hybrid_rl.run.logs.log import RunLog

CONFIG = {"task": "ant", "algo": "sac", "learners": {"policy": {"rate": 0.1}}}


def row(step, seed=0, **scalars):
    return {"step": step, "seed": seed, "wall_s": step / 2, **scalars}


def table(folder):
    with (folder / "metrics.csv").open() as file:
        return list(csv.reader(file))


def numbers(folder):
    """What metrics.jsonl holds, as lines of the table."""
    rows = rows_of(folder)
    return [
        [*(str(each[name]) for name in ("step", "seed", "wall_s")), name, str(value)]
        for each in rows
        for name, value in each.items()
        if name not in ("step", "seed", "wall_s") and isinstance(value, (int, float))
    ]


def test_the_table_has_the_numbers_of_the_rows_also_of_a_resumed_run(tmp_path):
    """What was written after the checkpoint, or cut, is not in it."""
    with RunLog(tmp_path, [0], {}, ["csv"]) as log:
        log.write([row(1, a=0.1, b=7), row(2, a=float("nan"), diverged="sac/q", c=1e-30)])
        assert table(tmp_path)[0] == ["step", "seed", "wall_s", "metric", "value"]
        assert table(tmp_path)[1:] == numbers(tmp_path)
        offset = log.flush()
        log.write([row(3, a=5.0)])
    with (tmp_path / "metrics.csv").open("a") as file:
        file.write("4,0,")
    with RunLog(tmp_path, [0], {}, ["csv"]) as log:
        log.rewind(offset, step=2)
        log.write([row(3, a=6.0)])
    assert table(tmp_path)[1:] == numbers(tmp_path)
    assert [line[3:] for line in table(tmp_path)[1:]] == [
        ["a", "0.1"],
        ["b", "7"],
        ["c", "1e-30"],
        ["a", "6.0"],
    ]


class Fake:
    """A run of W&B, and the module."""

    def __init__(self, **given):
        self.given, self.logged, self.ended = given, [], False

    def log(self, values, step):
        self.logged.append((step, values))

    def finish(self):
        self.ended = True


@pytest.fixture
def wandb(monkeypatch):
    """The runs of a module that stands in for W&B's."""
    runs = []

    def init(**given):
        runs.append(Fake(**given))
        return runs[-1]

    monkeypatch.setitem(sys.modules, "wandb", SimpleNamespace(init=init, Settings=dict))
    return runs


def test_each_seed_is_a_run_of_wandb_that_a_resumed_run_continues(tmp_path, wandb):
    for step in (1, 2):
        with RunLog(tmp_path, [3, 4], CONFIG, ["wandb"]) as log:
            log.write([row(step, 3, a=0.5, diverged="x"), row(step, 4, a=float("inf"), b=2)])
    first, second, again, _ = wandb
    assert first.logged == [(1, {"a": 0.5, "wall_s": 0.5})]
    assert second.logged == [(1, {"b": 2, "wall_s": 0.5})]
    assert [run.given["config"]["seed"] for run in wandb] == [3, 4, 3, 4]
    assert first.given["config"]["learners"] == CONFIG["learners"]
    assert first.given["id"] == again.given["id"] != second.given["id"]
    assert {run.given["group"] for run in wandb} == {str(tmp_path)}
    assert all(run.ended for run in wandb)


def test_trackio_gets_the_rows_of_a_seed_together(tmp_path, monkeypatch):
    """At a checkpoint, and the rest at the end; a resumed run continues its runs."""
    runs = []

    def init(**given):
        assert all(run.ended for run in runs)  # one at a time
        runs.append(Fake(**given))
        return runs[-1]

    module = SimpleNamespace(init=init, finish=lambda: runs[-1].finish())
    monkeypatch.setitem(sys.modules, "trackio", module)
    with RunLog(tmp_path, [3, 4], CONFIG, ["trackio"]) as log:
        for step in (1, 2):
            log.write([row(step, 3, a=0.5 * step), row(step, 4, a=float("inf"))])
        assert runs == []
        offset = log.flush()
        log.write([row(3, 3, a=3.0)])
    assert [run.logged for run in runs] == [
        [(1, {"a": 0.5, "wall_s": 0.5}), (2, {"a": 1.0, "wall_s": 1.0})],
        [(3, {"a": 3.0, "wall_s": 1.5})],
    ]
    with RunLog(tmp_path, [3, 4], CONFIG, ["trackio"]) as log:
        log.rewind(offset, step=2)
        log.write([row(3, 4, a=4.0)])
    assert [run.given["resume"] for run in runs] == ["never", "allow", "allow"]
    assert [run.given["config"]["seed"] for run in runs] == [3, 3, 4]
    assert {run.given["project"] for run in runs} == {"ant"}


def test_a_logger_is_unknown_or_not_installed_in_one_line(monkeypatch, tmp_path, capfd):
    assert loggers.check(None) == ()
    assert loggers.check(["csv"]) == ("csv",)
    with pytest.raises(UsageError, match="logger=mlflow: choose from csv, wandb, trackio, or null"):
        loggers.check(["csv", "mlflow"])
    monkeypatch.setenv("TRACKIO_DIR", str(tmp_path))
    for name in loggers.PACKAGES:
        monkeypatch.setitem(sys.modules, name, None)
        given = ["task=pendulum", "algo=sac", f"logger={name}", f"run_dir={tmp_path / 'run'}"]
        assert call_train(*given) == 2
        line = f'logger={name}: not installed; pip install "hybrid_rl[{name}]"'
        assert line in only_line(capfd)
        assert not (tmp_path / "run").exists()
