"""The command that runs a peer's own code, and the picture of peers."""

import json
import sys
import time
from functools import partial
from types import SimpleNamespace

import gymnasium
import numpy as np
import pytest
from tiny import call_command, only_line

from scripts import compare_peers, peers_picture
from scripts.pages import values

main = partial(call_command, compare_peers.main)
GIVEN = ["method=Rest", "env=Pendulum-v1"]
PEER = """
class Rest:
    def __init__(self, policy, env, seed):
        assert policy == "MlpPolicy"
        if seed == 8:
            raise RuntimeError("seed 8 fails")
        self.env, self.num_timesteps = env, 0
    def learn(self, steps, callback):
        self.env.reset(seed=0)
        while self.num_timesteps < steps:
            self.env.unwrapped.step(self.env.action_space.sample())
            self.num_timesteps += 1
            assert callback({}, {})
    def predict(self, obs, deterministic):
        assert deterministic
        return 0 * obs[:1], None
"""


@pytest.fixture
def peer(tmp_path, monkeypatch):
    """A library `sbx` whose one method never acts; its seed 8 fails."""
    (tmp_path / "sbx.py").write_text(PEER)
    monkeypatch.delitem(sys.modules, "sbx", raising=False)
    monkeypatch.syspath_prepend(tmp_path)


def resting(number):
    """Return of an episode of the pendulum without torque."""
    env = gymnasium.make("Pendulum-v1")
    env.reset(seed=compare_peers.FIRST_RESET + number)
    return sum(float(env.step(np.zeros(1, np.float32))[1]) for _ in range(200))


def test_each_seed_has_rows_of_evaluations_and_between_them(peer, tmp_path, capfd):
    out = tmp_path / "out.json"
    more = ["seeds=2", "seed=7", "total_steps=1500", "eval_every=500", "eval_episodes=2"]
    assert main(*GIVEN, *more, f"out={out}") == 1
    assert capfd.readouterr().err.splitlines()[-1] == "hybrid_rl: seed 8: ended by the error above"
    found = json.loads(out.read_text())
    expected = round(float(np.mean([resting(0), resting(1)])), 1)
    assert [row["step"] for row in found["rows"]["7"]] == [500, 1000, 1500]
    steps = {str(step): [expected] for step in (500, 1000, 1500)}
    assert found["returns"] == {"seeds": [7], **steps}
    assert found["clock"].keys() == {"learners", "first", "first_s", "rate"}
    assert main("method=None", "env=Pendulum-v1", f"out={out}") == 2
    assert only_line(capfd) == "hybrid_rl: method=None: sbx has no such class that learns\n"
    assert json.loads(out.read_text()) == found


def test_seconds_leave_evaluations_out(monkeypatch):
    """A decision takes 1 s here, an episode 7."""
    rows, now = [], SimpleNamespace(s=0.0)
    monkeypatch.setattr(time, "perf_counter", lambda: now.s)
    given = {"env": "Pendulum-v1", "eval_every": 1500, "eval_episodes": 3}
    record = compare_peers.Record(given, 0.0, rows.append)

    def episode(model, number):
        now.s += 7
        return float(number)

    monkeypatch.setattr(record, "episode", episode)
    for step in range(1, 3001):
        now.s += 1
        assert record.after(SimpleNamespace(num_timesteps=step))
    made = [(1000, 1000, None), (1500, 1500, 1.0), (2000, 2000, None), (3000, 3000, 1.0)]
    assert [tuple(row.values()) for row in rows] == made


def test_the_file_has_what_peers_json_has_of_a_method():
    rows = {
        101: [{"step": 1000, "s": 4.0, "return": None}, {"step": 2000, "s": 9.0, "return": 3.0}],
        100: [{"step": 1000, "s": 6.0, "return": None}, {"step": 2000, "s": 10.0, "return": 5.0}],
    }
    assert compare_peers.returns(rows) == {"seeds": [100, 101], "2000": [5.0, 3.0]}
    expected = {"learners": 1, "first": 1000, "first_s": 5.0, "rate": 225.0}
    assert compare_peers.clock(rows) == expected
    rows[100].append({"step": 3000, "s": 12.0, "return": 8.0})
    assert "3000" not in compare_peers.returns(rows)
    assert compare_peers.clock({100: rows[100][:1]}) is None


NAMES = ("peers", "bf16")
TABLES = values.RESULTS.parent / "tables.yaml"


@pytest.fixture(scope="module")
def results():
    """Numbers of the peers, and ours."""
    peers, ours = (json.loads((values.RESULTS / f"{name}.json").read_text()) for name in NAMES)
    return peers["h100"], ours["tasks"]


def test_minutes_are_the_first_seconds_and_the_other_decisions_of_all_learners(results):
    clocks = results[0]["clocks"]
    ten, peer = clocks["ten of hybrid_stochastic"], clocks["CrossQ"]
    at = np.array([1000.0, 50_000.0])
    expected = ten["first_s"] / 60 + 10 * at / ten["rate"] / 60
    np.testing.assert_allclose(peers_picture.minutes(ten, at), expected)
    assert peers_picture.minutes(peer, at)[0] == pytest.approx(peer["first_s"] / 60)
    rule = next(line for line in TABLES.read_text().splitlines() if "    to 50,000: '(" in line)
    text = rule.partition("'")[2].rstrip("'").replace("{label}", "CrossQ")
    assert values.evaluated(text)[0] == pytest.approx(peers_picture.minutes(peer, at)[1])
