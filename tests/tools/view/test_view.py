"""The live window: its programs, its pushes; the page itself in Chromium."""

import threading
from dataclasses import replace
from importlib.util import find_spec

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from chromium import PROGRAM, opened, until
from tiny import call_train, refusal, run

from hybrid_rl.envs.analytic.lander import Lander
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.envs.ant import Ant
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.legs import Legs
from hybrid_rl.envs.panda_stack import PandaStack
from hybrid_rl.envs.quadcopter import Quadcopter
from hybrid_rl.envs.sawyer_torque import SawyerTorque
from hybrid_rl.rewards.aim import Aim
from hybrid_rl.run import saved as trained
from hybrid_rl.tools.view import __main__ as view
from hybrid_rl.tools.view import programs, push
from hybrid_rl.tools.view.following import Follower
from hybrid_rl.tools.view.history import History
from hybrid_rl.tools.view.player import Choice, Player
from hybrid_rl.tools.view.subject import Source, Subject, learner, sliders, with_goals
from hybrid_rl.training.episode import Episode

BLANK = {each.name: each.default for each in view.ARGUMENTS}
PATIENCE = 60.0  # [s]


def player(policy, choice, changes=None):
    read = trained.read(policy)
    source = Source({**BLANK, "policy": policy}, changes or {}, read)
    return Player(source, learner(read, None), choice, seed=0)


def settle(one):
    """Wait until what was asked for acts, or is known not to fit."""

    def ready():
        one.exchange()
        return not one.compiling

    until(ready)


def test_a_number_of_the_goal_is_an_argument_of_the_program():
    """As if the episode had been made with it."""
    world = Pendulum()
    episode = Episode(world, reward=Aim(world, "height", 1.0))

    @jax.jit
    def reward(numbers, state):
        return with_goals(episode, episode, numbers).step(state, jnp.ones(1)).reward

    state = episode.reset(jax.random.key(0))
    for target in (-0.5, 0.25):
        made = Episode(world, reward=Aim(world, "height", target)).step(state, jnp.ones(1)).reward
        got = reward({"reward.target": jnp.float32(target), "reward.effort": 0.05}, state)
        assert got == pytest.approx(float(made), abs=1e-6)


def test_sliders_have_the_range_of_their_field():
    found = {one.key: one for one in sliders("reward", Aim(Pendulum(), "height", -3.0))}
    assert set(found) == {"reward.target", "reward.effort"}
    assert (found["reward.target"].least, found["reward.target"].most) == (-15, 15)
    assert found["reward.effort"].least == 0
    (mass,) = [one for one in sliders("env", HalfCheetah()) if one.key == "env.mass"]
    assert mass.least > 0
    stack = {one.key: one for one in sliders("env", PandaStack())}
    distance = stack["env.success_distance"]
    assert 0 < distance.least < distance.value < distance.most < 1  # [m]
    assert all(one.least >= 0 for one in stack.values())
    fault = {one.key: one for one in sliders("env", QuadcopterSE3())}
    assert (fault["env.rotor_loss"].least, fault["env.rotor_loss"].most) == (0, 1)
    rounds = {one.key: one for one in sliders("env", SawyerTorque())}["env.rounds"]
    assert (rounds.least, rounds.most, rounds.step) == (1, 10, 1)
    for world in (Lander(), Lander(turns=1.0)):
        (turns,) = sliders("env", world)
        assert (turns.value, turns.least, turns.most, turns.step) == (world.turns, 0.5, 1, 0.5)
    for world in (Quadcopter(), QuadcopterSE3()):
        (wind,) = [one for one in sliders("env", world) if one.key == "env.wind"]
        assert (wind.value, wind.least, wind.most) == (0, -5, 5)


def test_sliders_command_a_robot():
    subject = Subject(Episode(Legs(physics="native"), 1000), {}, frozenset())
    ranges = [(one.key, one.least, one.most) for one in subject.commands]
    assert ranges[:2] == [("command.forwards", -1, 1), ("command.left", -0.5, 0.5)]
    world, command = programs.world(subject.episode, {}), jnp.array([0.7, 0.0, -0.3])
    state = world.commanded(world.reset(jax.random.key(0)), command)
    after = world.step({}, state, jnp.zeros(12))
    np.testing.assert_array_equal([state.obs[-3:], after.obs[-3:]], [command] * 2)
    assert Subject(Episode(Pendulum()), {}, frozenset()).commands == []


def test_bodies_that_episodes_draw_act_in_the_window():
    noise = [0.0, 0.1, 0.1, 0.1, 0.1]
    drawn = {"episode.randomise.mass": "[2,3]", "episode.sensor_noise": str(noise)}
    one = player("cartpole", Choice("policy"), drawn)
    one.advance()
    mass = one.state.data.fields["body_mass"] / one.cast.world.episode.env._body.model.body_mass
    assert 2 <= mass[1] <= 3
    assert one.state.clock.decision == 1


def test_a_world_without_a_hash_is_shown(monkeypatch):
    """As a user's dataclass is for which a YAML file has a list."""
    monkeypatch.setattr(Pendulum, "__hash__", None)
    one = player("pendulum", Choice("policy"))
    one.advance()
    assert one.decided is not None


def test_another_body_acts_between_two_decisions_and_a_bad_one_never():
    one = player("cartpole", Choice("policy"))
    one.advance()
    before = np.asarray(one.state.data.qpos)
    one.choose(Choice("policy", changes={"env.mass": "3"}))
    settle(one)
    assert one.cast.world.episode.env.mass == 3
    assert one.state.data.asset != trained.read("cartpole").episode.env._body.asset
    np.testing.assert_array_equal(one.state.data.qpos, before)  # goes on, no new episode
    one.advance()
    assert one.state.clock.decision == 2
    one.choose(Choice("policy", changes={"episode.delay": "0.066"}))  # has another state
    settle(one)
    assert one.state.clock.sent.actions.shape == (3, 1)
    one.choose(Choice("policy", changes={"env.mass": "-1"}))
    settle(one)
    assert "mass=-1" in one.problem
    one.exchange()
    assert not one.compiling  # it is not asked for again
    assert one.cast.world.episode.delay == 0.066
    one.advance()
    one._enter(replace(one.cast, actor=replace(one.cast.actor, begin=lambda: "no plan")))
    assert one._control == "no plan"  # another one acts, who has a state of its own


def test_a_quick_planner_has_a_quarter_of_the_candidates():
    given = {**BLANK, "policy": "halfcheetah"}
    source = Source(given, {}, trained.read("halfcheetah"))
    whole, quick = (source.subject("speed", {}, quick=each) for each in (False, True))
    before, after = whole.controllers["full"], quick.controllers["full"]
    assert (after.samples, after.horizon) == (before.samples // 4, before.horizon)
    assert quick.plans("full")
    assert not quick.plans("policy")


def test_a_push_is_at_most_the_robots_weight():
    """In the air a pull at the torso changes the velocity of the whole robot by F dt / m."""
    env = Ant()
    state = jax.jit(env.reset)(jax.random.key(0))
    model = env._body.model
    mass, most = model.body_mass.sum(), push.GRAVITY
    assert np.linalg.norm(push.force(model, np.zeros(3), [9.0, 0, 0])) == pytest.approx(mass * most)
    near = push.force(model, np.zeros(3), [0.0, 0.01, 0])
    np.testing.assert_allclose(near, [0, 0.01 * push.STIFFNESS * mass, 0])
    at = np.asarray(state.data.qpos[:3], float)
    pull = push.Pull("torso", at, at + np.array([0, 0, 5.0]), 0.0)
    dv = push.change(state.data, pull, 0.05)
    assert 0.05 * most * 0.9 < dv[2] < 0.05 * most * 3  # the legs follow later
    moved = push.pushed(state, pull, 0.05)
    np.testing.assert_allclose(moved.data.qvel - state.data.qvel, dv, atol=1e-6)
    assert not push.change(state.data, push.Pull("nothing", at, at, 0.0), 0.05).any()


def test_a_run_is_followed_by_its_newest_checkpoint(tmp_path, monkeypatch):
    monkeypatch.setattr("hybrid_rl.tools.view.following.EVERY", 0.05)
    folder = tmp_path / "run"
    run(folder, "task=pendulum", "algo=sac")
    first = trained.load(folder)
    follower = Follower(folder, first, None)
    try:
        assert call_train(f"resume={folder}", f"total_steps={first.step + 20}") == 0
        params, step = until(follower.newest)
    finally:
        follower.close()
    assert step > first.step
    was, now = (jax.tree.leaves(each.policy) for each in (learner(first, None), params))
    assert any((a != b).any() for a, b in zip(was, now, strict=True))


def test_plots_leave_out_what_does_not_apply():
    history = History()
    for i in range(3):
        share = {"planner/policy_share": np.nan if i == 1 else 0.5}
        history.add(0.1 * i, float(i), share)
    assert history.curve("reward")[1].tolist() == [0, 1, 2]
    assert history.curve("agreement")[0].tolist() == [0, 0.2]
    assert len(history.curve("value")[0]) == 0


@pytest.mark.parametrize(
    ("words", "line"),
    [
        ("task=panda_stack mode=policy", "mode: is not for panda_stack"),
        ("policy=ant host=192.0.2.1", "host=192.0.2.1 port=8080: cannot be used"),
        ("policy=ant port=70000", "port=70000: must be a whole number, 1 to 65535"),
    ],
)
def test_what_does_not_fit_is_one_line(words, line, capfd):
    assert line in refusal(capfd, *words.split(), of=view.main)


@pytest.mark.skipif(not find_spec("viser"), reason="needs viser")
def test_a_world_that_cannot_be_drawn_is_one_line(capfd):
    words = ["task=gymnasium", "env.id=Pendulum-v1", "expert=babble"]
    assert "has no `scene` and no `pose`: the" in refusal(capfd, *words, of=view.main)


def test_without_viser_it_names_what_to_install(monkeypatch, capfd):
    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr(view, "import_module", missing)
    assert 'pip install "hybrid_rl[view]"' in refusal(capfd, "policy=pendulum", of=view.main)


@pytest.fixture
def window():
    """A session that plays, and its server."""
    if not (PROGRAM and find_spec("viser") and find_spec("mjviser")):
        pytest.skip("needs chromium and the extra `view`")
    server, link = view.serve({**BLANK, "port": 8471})
    given = {**BLANK, "policy": "halfcheetah", "mode": "policy"}
    session = view.open_session(given, {}, lambda: server)
    over = threading.Event()
    thread = threading.Thread(target=session.run, args=(over,))
    thread.start()
    yield session, server, link
    over.set()
    thread.join()
    server.stop()


def pixel(client, point):
    """Where [2] the browser draws a point [3]."""
    import viser.transforms as tf

    camera = client.camera
    width, height = camera.image_width, camera.image_height  # beside the panel
    x, y, z = tf.SO3(camera.wxyz).inverse() @ (point - camera.position)
    scale = height / 2 / np.tan(camera.fov / 2)
    return width / 2 + scale * x / z, height / 2 + scale * y / z


def test_the_page_shows_the_robot_steps_and_is_pushed(window, tmp_path):
    """Without an error, and without a request to another host."""
    session, server, link = window
    address = f"127.0.0.1:{server.get_port()}"
    with opened(tmp_path) as page:
        page.size(1280, 800)
        page.open(link)
        page.wait("document.body.innerText.includes('mode policy')")
        until(lambda: session.wishes.paused or page.click("Step"))  # the panel moves at first
        until(lambda: not session.wishes.steps)
        before = session.decisions
        page.click("Step")
        until(lambda: session.decisions == before + 1)
        session.wishes.paused = False
        client = until(lambda: next(iter(server.get_clients().values()), None))
        until(lambda: drag(page, session, client), 3 * PATIENCE)
        # viser's own page logs these, of its wheel and touch events and of its clock
        known = ("Unable to preventDefault inside passive event listener", "THREE.Clock")
        assert [each for each in page.errors if not any(one in each for one in known)] == []
        inside = (f"http://{address}", f"ws://{address}", "data:", "blob:")
        assert [each for each in page.requests if not each.startswith(inside)] == []


def drag(page, session, client):
    """Whether a drag of the torso has pushed the robot."""
    torso = session._scene._data.body("torso").xipos + session._scene.offset
    x, y = pixel(client, torso)
    page("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)  # no button: viser finds it
    page.mouse("mousePressed", x, y)
    for i in range(1, 8):
        page.mouse("mouseMoved", x + 10 * i, y - 5 * i)
    page.mouse("mouseReleased", x + 70, y - 35)
    return session.pushes
