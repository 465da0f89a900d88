"""The paths that the live window draws, and its session.

Positions along imagined observations; another goal, who may act, a robot that has tipped over.
"""

from dataclasses import replace

import jax
import numpy as np
import pytest
from chromium import until
from test_view import BLANK, player
from viser import ViserServer

from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.ant import Ant
from hybrid_rl.envs.cartpole import Cartpole
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.mujoco import scenery
from hybrid_rl.envs.sawyer_push import SawyerPush
from hybrid_rl.envs.sawyer_torque import SawyerTorque
from hybrid_rl.envs.sprk import Sprk
from hybrid_rl.errors import UsageError
from hybrid_rl.run import saved as trained
from hybrid_rl.tools.view import __main__ as view
from hybrid_rl.tools.view import imagined
from hybrid_rl.tools.view.player import Choice
from hybrid_rl.tools.view.scene import Scene
from hybrid_rl.tools.view.subject import Source
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import rollout
from hybrid_rl.types import Params


@pytest.mark.parametrize(
    ("env", "fits"),
    [
        (HalfCheetah(), 0.05),
        (Cartpole(), 1e-5),
        (Pendulum(), 1e-5),
        (SawyerTorque(), 1e-5),
        (Sprk(), None),
    ],
)
def test_positions_follow_from_observations(env, fits):
    """Of a true path of 20 decisions; not of a ball seen in another frame."""
    episode = Episode(env)
    read = imagined.reading(episode)
    if fits is None:
        assert read is None
        return

    still, key = ConstantController(0.3), jax.random.key(3)
    path = jax.jit(lambda: rollout(episode, still, Params(), key, 20))()
    first = jax.tree.map(lambda leaf: leaf[0], path)
    apart = np.asarray(read(first, path.obs) - jax.jit(jax.vmap(env.pose))(path))[1:]
    assert np.abs((apart + np.pi) % (2 * np.pi) - np.pi).max() < fits  # angles may turn round


def test_the_path_of_a_pendulum_is_that_of_its_tip():
    model = scenery.dressed(scenery.scene_of(Pendulum()))
    poses = np.array([[[0.0], [np.pi / 2], [np.pi]]])
    points = imagined.track(model, poses, *imagined.point_of(model))
    (line,) = imagined.lines(model, poses)
    np.testing.assert_array_equal(line, points)
    middle = points[0, [0, 2]].mean(0)
    away = np.linalg.norm(points[0] - middle, axis=1)
    np.testing.assert_allclose(away, away[0], rtol=1e-3)
    assert away[0] == pytest.approx(2 * np.linalg.norm(model.body_ipos[-1]), rel=1e-3)


def test_the_drawn_point_is_of_a_torso_a_pole_or_an_arm():
    models = [scenery.dressed(scenery.scene_of(env)) for env in (Ant(), Cartpole(), SawyerPush())]
    drawn = [model.body(imagined.point_of(model)[0]).name for model in models]
    assert drawn[:2] == ["torso", "pole"]
    assert drawn[2] not in ("block", "target")


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
