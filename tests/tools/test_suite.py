"""The suite: runs that continue, and a table beside peers' numbers."""

import json
import subprocess
from types import SimpleNamespace

import numpy as np
import pytest
import yaml
from tiny import call_command, refusal, write_run

from hybrid_rl.settings.build import compose_raw
from hybrid_rl.tools.suite import __main__ as suite

TASKS = {"one": {"train": "task=pendulum", "random": -10}, "two": {"train": "task=cartpole"}}


def test_it_begins_continues_and_leaves_out_and_writes_what_there_is(tmp_path, monkeypatch, capfd):
    file, out, peers = tmp_path / "my.yaml", tmp_path / "out", tmp_path / "peers.json"
    file.write_text(yaml.safe_dump({"at": [10, 20], "each": "num_envs=2", "tasks": TASKS}))
    theirs = {"one": {"20": [90, 80, 3]}, "two": {"20": [50, None, 5]}}
    of_both = {"A": {"tasks": theirs}, "B": {"tasks": {"one": {"20": [40, 1, 2]}}}}
    peers.write_text(json.dumps(of_both))
    lines = []
    done = SimpleNamespace(returncode=0)
    monkeypatch.setattr(subprocess, "run", lambda line, **_: lines.append(line[3:]) or done)
    given = [f"suite={file}", f"out={out}", "seeds=2", "seed=7", "train=algo=sac"]
    assert "no run of these tasks" in refusal(capfd, *given, of=suite.main)
    first = "task=pendulum num_envs=2 algo=sac total_steps=20 eval_every=1 checkpoint_every=2"
    assert lines[0] == [*first.split(), "seed=7", "num_seeds=2", f"run_dir={out / 'one'}"]
    for name, first, last in (("one", (0, 20), (30, 50)), ("two", (5, 5), (10, 20))):
        returns = {"eval/return": {10: first, 20: last}}
        write_run(out / name, "task: pendulum\nalgo: sac\n", returns, finished=name == "one")
    assert call_command(suite.main, *given, f"peers={peers}") == 0
    assert lines[2:] == [[f"resume={out / 'two'}"]]
    rows = [line.split(" | ") for line in out.with_suffix(".md").read_text().splitlines()]
    assert rows[2][3:] == ["40 [30, 50]; 40; 30", "A, 90 |"]
    assert [row[1:] for row in rows if row[0] == "| A"] == [["2", "1.00", "0.40 |"]]  # .5 and .3
    assert [row[1:] for row in rows if row[0] == "| B"] == [["1", "0.50", "0.50 |"]]
    assert json.loads(out.with_suffix(".json").read_text())["tasks"]["two"]["20"] == [10, 20]
    assert out.with_suffix(".png").stat().st_size > 1e4


@pytest.mark.parametrize("name", ["gymnasium", "dm_control"])
def test_the_tasks_of_a_suite_can_be_composed(name):
    one = suite.suite_of(name, "")
    given = {"train": "", "seed": 100, "seeds": 10}
    assert np.all([compose_raw(suite.words(one, task, given), None) for task in one["tasks"]])
