"""The learner that reads the rows of a robot's process."""

import threading
import time
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import jax.numpy as jnp
import numpy as np
import pytest
from counting import LINE, Counting, broken, lost, moved, of

from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import own_folder
from hybrid_rl.outside import robot_loop
from hybrid_rl.outside.lag import acted, known_lag
from hybrid_rl.outside.learner import transition
from hybrid_rl.outside.robot_loop import RobotProgram
from hybrid_rl.outside.robot_process import RobotProcess
from hybrid_rl.run.members import loop_of
from hybrid_rl.settings import build as config


def test_the_learner_learns_from_the_rows(agent, tmp_path, monkeypatch):
    """Its memory is what the file holds; a gap ends the row before; a call may end early."""
    loop = loop_of(of(agent, broken(lost)), (0,), 20, tmp_path)
    _, rows = moved(agent, own_folder(loop.folder), broken(lost))
    monkeypatch.setattr(RobotProcess, "watch", lambda self: None)
    state = loop.init()
    program = loop.compile(state)
    state, metrics = program(state, jnp.int32(0), jnp.int32(20))
    state, more = program(state, jnp.int32(20), jnp.int32(10))
    memory = np.asarray(state.memory.rows)[0, :30, 0]
    assert np.array_equal(memory[:, :4], [row["obs"] for row in rows[:30]])
    each = [acted(row["sent"], row["times"], row["interval"], 0.0) for row in rows[:30]]
    np.testing.assert_allclose(memory[:, 4:5], each, atol=1e-6)  # no random rows, no lag
    assert not np.array_equal(memory[:, 4:5], [row["action"] for row in rows[:30]])
    assert known_lag(loop.agent.episode.env, loop.folder) == 0
    assert np.array_equal(memory[:, -4:], [row["next_obs"] for row in rows[:30]])
    cut = [row["stretch"] != after["stretch"] for row, after in pairwise(rows[:31])]
    ended = [bool(row["terminated"]) for row in rows[:30]]
    assert sum(cut) >= 3  # time limits, and the gap
    wanted = [c and not e for c, e in zip(cut, ended, strict=True)]
    assert (memory[:, 7] == 1).tolist()[:29] == wanted[:29]  # the last one's follower is unread
    assert (memory[:, 6] == 1).tolist() == ended
    assert metrics["episode/length"][:, 0, 0].tolist() == [*range(1, 11), *range(1, 11)]
    assert len(more["episode/done"]) == len(more["robot/late_s"]) == 10
    assert more["robot/behind"].tolist() == [[len(rows) - 30]] * 10
    threading.Timer(0.5, loop.cut_short).start()
    state, more = program(state, jnp.int32(30), jnp.int32(1000))  # no row comes any more
    assert len(more["episode/done"]) == len(rows) - 30


def test_reading_and_learning_share_the_time_of_a_slow_learner(agent, tmp_path, monkeypatch):
    """Each decision has its updates, also after an interruption, though rows always wait."""
    loop = loop_of(of(agent, Counting), (0,), 20, tmp_path)
    _, rows = moved(agent, own_folder(loop.folder), Counting)
    monkeypatch.setattr(RobotProcess, "watch", lambda self: None)
    observe, learn = loop.halves(loop.init())
    monkeypatch.setattr(loop, "halves", lambda state: [observe, slowly])
    learned, state = [], loop.init()

    def slowly(*given):
        time.sleep(5e-3)
        learned.append(int(given[-1]))
        return learn(*given)

    slowly.memory_analysis = learn.memory_analysis

    for start in (0, 12):
        program = RobotProgram(loop, state)
        state, metrics = program(state, jnp.int32(start), jnp.int32(12))
        assert learned == list(range(start + 12))
        rewards = [row["reward"] for row in rows[start : start + 12]]
        assert metrics["world/reward"].ravel().tolist() == rewards
    count = int(state.memory.count[0])
    assert count > 30  # it reads on while it learns
    memory = np.asarray(state.memory.rows)[0, :count, 0]
    assert np.array_equal(memory[:, :4], [row["obs"] for row in rows[:count]])


@pytest.mark.parametrize("word", ["num_seeds=2", "num_envs=2"])
def test_one_robot_has_one_learner(word):
    run = config.build(config.load([*LINE, word]))
    with pytest.raises(UsageError, match="one robot has one learner"):
        loop_of(run.agent, run.seeds, 20)


def test_the_lag_is_estimated_from_the_random_decisions(agent, tmp_path, monkeypatch):
    """Then the memory holds what acted, from its first row on, and the robot's process knows it."""
    monkeypatch.setattr(robot_loop, "estimated", lambda *given: 0.005)
    monkeypatch.setattr(RobotProcess, "watch", lambda self: None)
    loop = loop_of(replace(of(agent, Counting), random_steps=15), (0,), 20, tmp_path)
    _, rows = moved(agent, own_folder(loop.folder), Counting)
    state = loop.init()
    program = loop.compile(state)
    for step in (0, 10):
        state, metrics = program(state, jnp.int32(step), jnp.int32(10))
        read = int(state.memory.count[0])
        kept = np.asarray(state.memory.rows)[0, :read, 0, 4:5]
        lag = 0.005 if read >= 15 else None
        each = [transition(row, lag).action[0, 0] for row in rows[:read]]
        np.testing.assert_allclose(kept, each, atol=1e-6)
    assert read >= 15
    assert known_lag(loop.agent.episode.env, loop.folder) == 0.005
    robot_lag = metrics["robot/lag"][-1, 0]
    assert robot_lag == pytest.approx((0.005 + rows[19]["age"]) / Counting.dt, rel=1e-4)
    monkeypatch.setattr(robot_loop, "FOLLOWED", 4)
    monkeypatch.setattr(robot_loop, "followed", lambda *given: 0.009)
    program.model = SimpleNamespace(lift=lambda params, obs: obs, step=lambda params, x, u: x)
    state, _ = program(state, jnp.int32(20), jnp.int32(5))
    assert known_lag(loop.agent.episode.env, loop.folder) == 0.009
    read = int(state.memory.count[0])
    kept = np.asarray(state.memory.rows)[0, :read, 0, 4:5]
    each = [transition(row, 0.009).action[0, 0] for row in rows[:read]]
    np.testing.assert_allclose(kept[-4:], each[-4:], atol=1e-6)
    assert not np.allclose(kept[:15], each[:15])
    again, _ = loop.compile(state)(state, jnp.int32(25), jnp.int32(5))  # a resumed learner
    assert again.memory.rows.shape == state.memory.rows.shape
