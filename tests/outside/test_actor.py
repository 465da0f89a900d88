"""The process that owns a robot, in this process."""

import threading
import time
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import ClassVar

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from counting import Counting, Rising, broken, lost, moved, of

from hybrid_rl.envs.adapters.robot import PENDING
from hybrid_rl.errors import WorldError
from hybrid_rl.outside import actor as actors
from hybrid_rl.outside.actor import Actor
from hybrid_rl.outside.robot_process import RobotProcess
from hybrid_rl.outside.row_log import RowLog
from hybrid_rl.training.ahead import AheadState


def test_rows_are_decisions_in_order(agent, tmp_path):
    actor, rows = moved(agent, tmp_path, Counting, rate=0.1)
    assert len(rows) > 30
    assert [row["number"] for row in rows] == list(range(len(rows)))
    for row, after in pairwise(rows):
        if row["stretch"] == after["stretch"]:
            assert np.array_equal(row["next_obs"], after["obs"])
        assert row["next_obs"][1] == row["obs"][1] + 1 == row["reward"]
    for episode in (1, 2):  # a missed deadline leaves decisions out
        assert [row["truncated"] for row in rows if row["episode"] == episode] == [0] * 9 + [1]
    third = [row for row in rows if row["episode"] == 3]
    assert [row["terminated"] for row in third] == [row["next_obs"][1] > 5 for row in third]
    _, more = moved(agent, tmp_path, Counting)  # another process goes on with the file
    assert [row["number"] for row in more] == list(range(len(more)))
    assert more[len(rows)]["stretch"] > rows[-1]["stretch"]
    assert more[len(rows)]["episode"] > rows[-1]["episode"]
    applied = np.array(actor.robot.applied)
    assert applied.min() >= 0
    assert applied.max() <= 2
    assert actor.robot.stopped == 1
    for row, after in pairwise(rows):
        if row["stretch"] == after["stretch"]:
            assert abs(after["action"] - row["action"]) <= 0.1 + 1e-6


def test_a_row_holds_what_was_sent_and_when(agent, tmp_path):
    """The decisions before it, as far as they follow each other; at first the safe action."""
    actor, rows = moved(agent, tmp_path, Counting)
    assert not actor._decide.predicts  # so it holds no action back
    assert {float(u) for row in rows for u in row["sent"][row["times"] < -9, 0]} == {-0.5}
    pairs = [(a, b) for a, b in pairwise(rows) if a["stretch"] == b["stretch"]]
    assert len(pairs) > 5
    for row, after in pairs:
        assert row["sent"][0] == row["action"]
        assert row["times"][0] == pytest.approx(row["age"], abs=1e-5)
        assert np.array_equal(after["sent"][1:], row["sent"][:-1])
        ago = row["times"] - row["interval"]  # the same times, since the next observation
        np.testing.assert_allclose(after["times"][1:], ago[:-1], atol=1e-5)


def test_it_acts_at_the_observation_predicted_for_then(agent, tmp_path):
    """What was sent, and how late: the controller's action says both. It is held until then."""

    @dataclass(frozen=True)
    class Telling:
        inner: tuple = ()

        def init(self, spec):
            return AheadState(jnp.zeros((PENDING + 1, 1)), jnp.zeros(()), ())

        def act(self, params, state, obs, key):
            return jnp.where(obs[1] % 2 == 0, 0.5 * state.sent[-1], state.lag[None] / 8), state, {}

        def greedy(self):
            return self

    actor, rows = moved(replace(agent, controller=Telling()), tmp_path, Counting, lag=0.006)
    assert actor._decide.predicts
    half = [row for row in rows if row["obs"][1] % 2 == 0]
    assert all(row["action"] == pytest.approx(0.5 * row["sent"][1]) for row in half)
    pairs = [(8 * row["action"][0], row["times"][0]) for row in rows if row["obs"][1] % 2]
    lags, sent = np.array(pairs, float).T
    assert len(lags) > 10
    assert {*lags} <= {2.0, 3.0, 4.0}  # 1.5 and the age of the observation, in periods of 4 ms
    assert (sent + 0.006 > 0.004 * lags - 0.002).all()


def test_an_episode_begins_with_a_controller_that_remembers_nothing(agent, tmp_path):
    _, rows = moved(replace(agent, controller=Rising(0.0, 0.05)), tmp_path, Counting)
    first = {row["episode"]: float(row["action"][0]) for row in reversed(rows)}
    assert len(first) > 3
    assert max(first.values()) < 0.4  # a missed deadline leaves decisions out


def test_it_ends_with_the_decisions_of_the_run(agent, tmp_path):
    params = agent.params(agent.init(jax.random.key(0)))
    for most in (15, 18):  # the second process finds those of the first
        actor = Actor(of(agent, Counting), tmp_path, params=params, most=most)
        actor.run(seconds=20)
        assert RowLog(tmp_path / "rows", agent.spec).count() == most
        assert actor.robot.stopped == 1


def test_it_ends_without_a_learner(agent, tmp_path):
    actor = Actor(of(agent, Counting, alone_s=0.2), tmp_path)
    began = time.monotonic()
    with pytest.raises(TimeoutError, match=r"Counting: no sign of its learner for 0.2 s"):
        actor.run()
    assert 0.1 < time.monotonic() - began < 5
    assert actor.robot.stopped == 1
    assert not actor.robot.applied
    (tmp_path / "stop").touch()  # the learner is there, and says so
    asked = Actor(of(agent, Counting, alone_s=9.0), tmp_path)
    began = time.monotonic()
    asked.run()
    assert time.monotonic() - began < 5


@pytest.mark.parametrize(
    "fault",
    [
        lost,
        lambda obs: (obs * np.nan, time.monotonic()),
        lambda obs: (obs, time.monotonic() - 1),
        lambda obs: (obs, np.nan),
    ],
    ids=["silent", "nan", "stale", "timeless"],
)
def test_without_an_observation_the_action_is_safe(agent, tmp_path, fault):
    actor, rows = moved(agent, tmp_path, broken(fault), stale=20.0)
    assert actor.counts.unsafe == actor.counts.stale == 1
    assert 0.5 in actor.robot.applied
    second = {int(row["obs"][1]): int(row["stretch"]) for row in rows if row["episode"] == 2}
    assert len(second) == 10
    assert not second.keys() & {3, 4}  # the decision before has no outcome
    before, after = (
        [s for at, s in second.items() if (at < 3) == early] for early in (True, False)
    )
    assert max(before) < min(after)


def test_observations_that_are_always_old_are_acted_on(agent, tmp_path):
    class Far(Counting):
        def observe(self) -> tuple:
            return super().observe()[0], time.monotonic() - 0.1  # 25 periods

    actor, rows = moved(agent, tmp_path, Far, stale=10.0)
    assert actor.counts.stale == 0
    assert min(row["age"] for row in rows) >= 0.1


def test_a_robot_that_falls_silent_is_stopped_and_awaited(agent, tmp_path, monkeypatch):
    monkeypatch.setattr(actors, "RETRY_S", 0.02)

    class Silent(Counting):
        faults: ClassVar[dict] = {(2, count): lost for count in range(4, 25)}

    actor, rows = moved(agent, tmp_path, Silent, silence_s=0.05)
    assert actor.robot.stopped >= 2
    assert rows[-1]["episode"] > 2


def test_a_robot_whose_reset_fails_is_tried_again_and_given_up(agent, tmp_path, monkeypatch):
    monkeypatch.setattr(actors, "RETRY_S", 0.02)
    made = []

    class Stuck(Counting):
        def reset(self) -> None:
            made.append(time.monotonic())
            raise ConnectionError("no bus")

    stuck, params = of(agent, Stuck, alone_s=0.3), agent.params(agent.init(jax.random.key(0)))
    actor = Actor(stuck, tmp_path, params=params, recording=False)
    with pytest.raises(TimeoutError, match=r"Stuck: reset: ConnectionError: no bus, nothing else"):
        actor.run(seconds=2.0)
    assert 1 < len(made) < 30
    process = RobotProcess(stuck.episode.env, tmp_path)
    monkeypatch.setattr(process, "alive", lambda: True)
    process.watch()
    assert "Stuck: reset: ConnectionError: no bus; waiting for it" in process.shown
    (tmp_path / "error").write_text("the line with which it is about to end")
    process.checked = 0.0
    process.watch()
    assert "waiting for it" in process.shown  # that line is shown once, by the run's end


@pytest.mark.parametrize(
    ("method", "line"),
    [
        ("clock", r"observe: must return .* its time\.monotonic\(\)\); it returned .*, 1"),
        ("observe", r"observe: must return \(observation \[4\], .*\); it returned \(array"),
        ("untimed", r"observe: must return .*, None\)"),
        ("reward", r"reward: gives nan"),
        ("apply", r"apply: .*test_actor.py:\d+: ZeroDivisionError"),
    ],
)
def test_a_mistake_in_the_class_ends_motion_with_its_line(agent, tmp_path, method, line):
    wrong = {
        "observe": lambda self: (np.zeros(3), time.monotonic()),
        "clock": lambda self: (np.zeros(4), time.time()),
        "untimed": lambda self: (np.zeros(4), None),
        "reward": lambda self, obs, action, next_obs: float("nan"),
        "apply": lambda self, action: 1 / 0,
    }
    stopped, name = [], method if method in ("reward", "apply") else "observe"
    kind = type("Wrong", (Counting,), {name: wrong[method], "stop": lambda _: stopped.append(1)})
    with pytest.raises(WorldError, match=line):
        moved(agent, tmp_path, kind)
    assert len(stopped) == 1


def test_a_method_that_does_not_return_ends_motion_and_the_process(agent, tmp_path, monkeypatch):
    codes, over = [], threading.Event()

    def leave(code):
        codes.append(code)
        over.set()
        time.sleep(0.3)  # so that the thread does not check again

    monkeypatch.setattr(actors.os, "_exit", leave)
    silent = broken(lambda obs: (obs, over.wait(5) and time.monotonic()))
    actor, _ = moved(agent, tmp_path, silent, silence_s=0.1)
    assert codes[0] == actors.LOST
    assert actor.robot.stopped >= 2
    assert "observe: did not return in 0.1 s" in (tmp_path / "error").read_text()
