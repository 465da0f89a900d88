"""A learner in a loop of the user's own."""

import time

import jax
import numpy as np
import pytest
from programs import kept, shared

import hybrid_rl
from hybrid_rl import OnlineLearner
from hybrid_rl.errors import DivergenceError, UsageError
from hybrid_rl.outside.learner import RowLoop

METHOD = ["algo=sac", "policy.hidden=[8]", "critic.hidden=[8]", "policy_learner.batch_size=4"]
METHOD += ["random_steps=0", "total_steps=100"]


@pytest.fixture(scope="module", autouse=True)
def programs():
    """Learners of equal agents share what observes and what learns."""
    halves = RowLoop.halves

    def remembered(self, state):
        def made():
            return halves(self, state), self.rows

        found, self.rows = kept(made, "halves", self.agent, jax.config.jax_debug_nans)
        return found

    with shared(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(RowLoop, "halves", remembered)
        yield


def made(learn="inline", *more):
    """A learner in a world of two numbers."""
    return OnlineLearner([*METHOD, *more], obs=2, act=1, learn=learn)


@pytest.fixture(scope="module")
def one(programs):
    return made()


@pytest.fixture
def learner(one):
    """One for all mistakes, which it survives."""
    one.interrupt()
    return one


def drive(learner, decisions, episode=5, first=0):
    """(obs, action) of decisions in a world that counts, with the time limit `episode`."""
    taken = []
    for i in range(first, first + decisions):
        obs = np.array([i % episode, 1.0])
        action = learner.act(obs)
        taken.append((obs, action))
        learner.observe(float(i), [i % episode + 1, 1.0], truncated=i % episode == episode - 1)
    return taken


def memory(learner, count):
    """Rows [count, width] of the replay memory."""
    return np.asarray(learner._learner.state.memory.rows)[0, :count, 0]


@pytest.mark.parametrize("learn", ["inline", "between_episodes"])
def test_the_memory_holds_what_was_done(learn):
    learner = made(learn)
    taken = drive(learner, 10)
    rows = memory(learner, 10)
    assert np.array_equal(rows[:, :2], [obs for obs, _ in taken])
    assert np.array_equal(rows[:, 2], [action[0] for _, action in taken])
    assert rows[:, 3].tolist() == list(range(10))
    assert np.flatnonzero(rows[:, 5]).tolist() == [4, 9]
    assert learner.decisions == learner.updates == 10
    assert np.isfinite(learner.metrics["sac/critic_loss"])


def test_what_acted_is_remembered_and_a_break_ends_the_decision_before():
    learner = made()
    learner.act([0, 0])
    learner.observe(1.0, [1, 1], executed=[0.25])
    learner.act([1, 1])
    learner.interrupt()  # without an outcome
    learner.act([5, 5])
    learner.observe(2.0, [6, 6], terminated=True, truncated=True)  # as an end by the task alone
    rows = memory(learner, 2)
    assert rows[0, 2] == 0.25
    assert rows[:, 5].tolist() == [1, 0]
    assert rows[:, 4].tolist() == [0, 1]


@pytest.mark.parametrize("algo", ["sac", "nn_mppi"])
def test_a_robot_that_is_late_is_learned_from_with_what_acted(algo):
    method = [f"algo={algo}", "settings=light", "random_steps=4", "total_steps=100"]
    late = OnlineLearner([*method, "episode.lag=0.065"], obs=2, act=1, learn="inline")
    sent = np.concatenate([u for _, u in drive(late, 8)])
    before = np.concatenate(([0], sent[:4], [0], sent[5:7]))  # 1.3 is 1; 0 before an episode
    np.testing.assert_allclose(memory(late, 8)[:, 2], before, rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize(
    "ends", [OnlineLearner.interrupt, lambda each: each.observe(0.0, [0, 0], terminated=True)]
)
def test_an_episode_begins_with_a_controller_that_remembers_nothing(learner, ends):
    learner.act([0, 0])
    learner._decide._acting.control = "a plan"  # sac itself remembers nothing
    ends(learner)
    assert learner._decide._acting.control == ()


def test_it_learns_in_the_background():
    with made("background") as learner:
        first = learner._decide.params
        drive(learner, 20)
        until = time.monotonic() + 20
        while learner.updates < 20 and time.monotonic() < until:
            time.sleep(0.01)
        time.sleep(0.2)
        assert learner.updates == 20
        assert learner._decide.params is not first
    with pytest.raises(UsageError, match="closed"):
        learner.act([0, 0])


def test_what_is_saved_goes_on_and_acts(tmp_path):
    learner = made()
    drive(learner, 10)
    learner.save(tmp_path / "run")
    again = OnlineLearner.load(tmp_path / "run", learn="inline")
    assert again.decisions == 10
    assert np.array_equal(memory(again, 10), memory(learner, 10))
    assert again.updates == 0
    drive(again, 5, first=10)
    assert again.updates == 5
    again.save(tmp_path / "run")
    assert OnlineLearner.load(tmp_path / "run", learn="inline").decisions == 15
    with pytest.raises(UsageError, match=r"use hybrid_rl\.OnlineLearner"):
        hybrid_rl.train([f"resume={tmp_path / 'run'}"])
    policy = hybrid_rl.load(tmp_path / "run").policy()
    assert policy(np.zeros(2)).shape == (1,)


def observe(*outcome, **more):
    """A call that acts, and observes this."""
    return lambda each: (each.act([0, 0]), each.observe(*outcome, **more))


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (lambda each: each.act([0]), r"obs is \[1\]; it must be \[2\]"),
        (lambda each: each.act([0, np.nan]), "obs: entry 1 is not finite"),
        (lambda each: each.act(["a", 0]), r"obs: must be numbers \[2\]"),
        (lambda each: each.observe(0.0, [0, 0]), "there is no action yet"),
        (lambda each: (each.act([0, 0]), each.act([0, 0])), "observe or interrupt first"),
        (observe(1e39, [0, 0]), "reward is not finite"),
        (observe([1.0], [0, 0]), r"reward is \[1\]; it must be one number"),
        (observe(0.0, [0, 0], executed=[5]), r"executed: entry 0 must lie in \[-1, 1\]"),
    ],
)
def test_mistakes_are_one_line(learner, call, line):
    with pytest.raises(UsageError, match=line):
        call(learner)


def test_wrong_arguments_are_refused(tmp_path):
    with pytest.raises(UsageError, match="learn=later: choose one of"):
        made("later")
    with pytest.raises(UsageError, match=r"obs=0: must be a whole number, 1 or more"):
        OnlineLearner(METHOD, act=1)
    with pytest.raises(UsageError, match="folder="):
        OnlineLearner.load(tmp_path)
    with pytest.raises(UsageError, match=r"resume=: is of train; OnlineLearner has .* load"):
        OnlineLearner(["resume=runs/mine"], obs=2, act=1)


def test_save_replaces_what_it_wrote_and_no_other_run(learner, tmp_path):
    learner.save(tmp_path / "mine")
    first = learner.decisions
    newer = tmp_path / "mine" / "checkpoints"
    (newer / str(first)).rename(newer / str(first + 7))  # as of a longer session
    learner.save(tmp_path / "mine")
    assert [path.name for path in newer.iterdir()] == [str(first)]
    (tmp_path / "config.yaml").write_text("task: pendulum\nenv: {dt: 1.0}\n")
    with pytest.raises(UsageError, match="holds a run that OnlineLearner did not write"):
        learner.save(tmp_path)
    assert not (tmp_path / "checkpoints").exists()


def test_a_learner_that_diverged_gives_no_action(learner):
    sound = learner._decide.params
    learner._decide.params = jax.tree.map(lambda leaf: np.full_like(leaf, np.nan), sound)
    with pytest.raises(DivergenceError, match="the learner reached NaN"):
        learner.act([0, 0])
    learner._decide.params = sound
    assert np.isfinite(learner.act([0, 0])).all()


def test_a_checkpoint_of_another_run_is_one_line(tmp_path):
    """Its config.yaml says what it was trained with, and so does the checkpoint."""
    learner = made()
    drive(learner, 3)
    learner.save(tmp_path / "a")
    text = (tmp_path / "a" / "config.yaml").read_text()
    for key, now in (("seed: 0", "1"), ("obs: 2", "3")):
        assert key in text
        edited = text.replace(key, f"{key.partition(' ')[0]} {now}")
        (tmp_path / "a" / "config.yaml").write_text(edited)
        with pytest.raises(UsageError, match=f"was {key.partition(' ')[2]} and is {now}; put it"):
            OnlineLearner.load(tmp_path / "a", "inline")
