"""Copies of the rows for Weights & Biases, without a network."""

import sys
from types import SimpleNamespace

import pytest
from test_log import row
from tiny import refusal

from hybrid_rl.run.logs.log import RunLog

CONFIG = {"task": "ant", "algo": "sac", "logger": "wandb", "learners": {"policy": {"rate": 0.1}}}


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
        with RunLog(tmp_path, [3, 4], CONFIG) as log:
            log.write([row(step, 3, a=0.5, diverged="x"), row(step, 4, a=float("inf"), b=2)])
    first, second, again, _ = wandb
    assert first.logged == [(1, {"a": 0.5, "wall_s": 0.333})]
    assert second.logged == [(1, {"b": 2, "wall_s": 0.333})]
    assert [run.given["config"]["seed"] for run in wandb] == [3, 4, 3, 4]
    assert first.given["config"]["learners"] == CONFIG["learners"]
    assert first.given["id"] == again.given["id"] != second.given["id"]
    assert {run.given["group"] for run in wandb} == {str(tmp_path)}
    assert all(run.ended for run in wandb)


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("mlflow", "logger=mlflow: choose one of null, wandb"),
        ("wandb", 'logger=wandb: not installed; pip install "hybrid_rl[wandb]"'),
    ],
)
def test_a_logger_is_unknown_or_not_installed_in_one_line(monkeypatch, tmp_path, capfd, name, line):
    monkeypatch.setitem(sys.modules, "wandb", None)
    given = ["task=pendulum", "algo=sac", f"logger={name}", f"run_dir={tmp_path / 'run'}"]
    assert line in refusal(capfd, *given)
    assert not (tmp_path / "run").exists()
