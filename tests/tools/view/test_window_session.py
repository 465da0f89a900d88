"""The session of a live window: another goal, who may act, a robot that has tipped over."""

from dataclasses import replace

import numpy as np
import pytest
from chromium import until
from test_view import BLANK, player
from viser import ViserServer

from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.errors import UsageError
from hybrid_rl.run import saved as trained
from hybrid_rl.tools.view import __main__ as view
from hybrid_rl.tools.view import imagined
from hybrid_rl.tools.view.player import Choice
from hybrid_rl.tools.view.scene import Scene
from hybrid_rl.tools.view.subject import Source


@pytest.fixture
def server():
    one, _ = view.serve({"host": "127.0.0.1", "port": 8481})
    yield one
    one.stop()


def test_another_goal_begins_a_new_return(server: ViserServer, monkeypatch):
    """And a new episode, but only of a robot that has tipped over."""
    session = view.open_session({**BLANK, "policy": "pendulum"}, {}, lambda: server)
    for tipped in (False, True):
        monkeypatch.setattr(Scene, "tipped", tipped)
        session._decide()
        decided = int(session.player.state.clock.decision)
        assert session.player.state.clock.total != 0
        goal = "" if session.wishes.choice.reward else "height"
        session.wishes.choice = replace(session.wishes.choice, reward=goal)
        until(lambda goal=goal: session._grant() or session.player.cast.choice.reward == goal)
        clock = session.player.state.clock
        assert clock.total == 0
        assert len(session._history.curve("reward")[1]) == 0
        assert clock.decision == (0 if tipped else decided)
        assert ("tipped over" in session._line()) == tipped
    session.player.close()


def test_a_walking_robot_on_its_back_has_tipped_over(server: ViserServer):
    scene = Scene(server, HalfCheetah(), lambda _: None)
    assert not scene.tipped
    pose = np.zeros(scene.model.nq)
    for pitch, tipped in ((0.5, False), (3.0, True), (6.3, False)):
        pose[2] = pitch
        scene.draw(pose)
        assert scene.tipped == tipped


def test_a_policy_with_a_model_plans_and_each_mode_is_listed_once():
    source = Source({**BLANK, "policy": "halfcheetah"}, {}, trained.read("halfcheetah"))
    subject = source.subject("", {})
    assert list(subject.controllers) == ["full", "policy", "planner"]
    assert hasattr(subject.controllers["full"], "considered")
    assert imagined.of_policy(subject.episode, subject.controllers, "policy")


def test_a_policy_alone_is_one_mode():
    assert player("cartpole", Choice("full")).modes == ["policy"]
    with pytest.raises(UsageError, match="mode=planner: choose one of policy"):
        player("cartpole", Choice("planner"))
