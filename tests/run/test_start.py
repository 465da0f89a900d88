"""train run=DIR: a new run begins with what another one knows, as far as it is true there."""

import shutil
from types import SimpleNamespace

import jax
import numpy as np
import pytest
from omegaconf import OmegaConf
from programs import shared
from tiny import call_train, contents, finished, refusal, rows_of, summary_of

from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.errors import UsageError
from hybrid_rl.run import folder, members, start
from hybrid_rl.run import saved as trained
from hybrid_rl.settings import build as config
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.loop import Loop
from scripts import interrupt

HYBRID = ["task=quadcopter", "algo=hybrid_stochastic", "learning=replay", "physics=native"]
HYBRID += ["episode.steps=40", "checkpoint_every=150", "eval_every=150", "eval_modes=[policy]"]
MOTION = ["reward=aim", "reward.quantity=motion", "reward.target=[0,0,1,0,0,0]"]


# A run of one learner; its memory holds the last 200 of 300 decisions.
source = finished(*HYBRID, "total_steps=300", "seed=4")


@pytest.fixture(scope="module")
def warm(source, tmp_path_factory):
    """A run that began with it, and changed its model alone."""
    folder = tmp_path_factory.mktemp("warm") / "run"
    line = [f"run={source}", f"run_dir={folder}", "total_steps=150", "freeze=[policy]"]
    assert call_train(*line, *MOTION) == 0
    return folder


def begun(source, *overrides):
    """Configuration, loop and first state of a run that begins with `source`."""
    made = members.load([f"run={source}", *overrides])[0].config
    with shared():
        built, first = start.build_new_run(made)
        loop = Loop(built.agent, built.seeds, 1)
        return made, loop, first.given(loop.init()), first.line


def saved(path, part="learners"):
    """A part of the state in the newest checkpoint of a run."""
    run = trained.build_run(folder.read(path, "run"))
    return getattr(trained.restore(path, run, part)[1], part)


def same(one, two):
    """Whether all leaves are equal bit for bit."""
    return jax.tree.all(jax.tree.map(np.array_equal, one, two))


def test_it_begins_with_all_that_the_learners_know(source):
    made, loop, state, line = begun(source, "policy_learner.tau=0.01", "total_steps=50")
    assert same(jax.device_get(state.learners), saved(source))
    params = jax.tree.map(lambda leaf: leaf[0], jax.vmap(loop.agent.params)(state))
    obs = state.env.obs[0, 0]
    actor, theirs = trained.load(source).learner(mode="policy")
    first, key = actor.init(loop.agent.spec), jax.random.key(3)
    mine, wanted = (actor.act(each, first, obs, key)[0] for each in (params, theirs))
    assert np.array_equal(mine, wanted)
    assert (made.random_steps, made.seed, made.total_steps, made.log_every) == (0, 4, 50, 50)
    assert made.learners.policy.tau == made.policy_learner.tau == 0.01
    assert made.policy.hidden == [16]
    assert "begins with model, reward, policy and critic of" in line
    assert "at step 300; memory: its last 200 decisions" in line


def test_the_memory_stays_where_it_is_true(source):
    _, loop, state, _ = begun(source, "episode.steps=30", "total_steps=50", "replay.capacity=1000")
    rows, old = np.asarray(state.memory.rows[0]), np.asarray(saved(source, "memory").rows[0])
    assert rows.shape[0] == 250
    assert int(state.memory.count[0]) == 200
    in_time = np.roll(old, -(300 % 200), axis=0)
    in_time[-1, :, -10] = 1  # another episode follows: truncated
    assert np.array_equal(rows[:200], in_time)
    assert set(loop.agent.starts().values()) == {0}
    _, _, state, _ = begun(source, "replay.capacity=60")
    assert int(state.memory.count[0]) == 60
    assert np.array_equal(state.memory.rows[0], in_time[-60:])


def test_another_reward_is_that_of_the_memory_too(source):
    made, loop, state, line = begun(source, *MOTION)
    assert "200 decisions, with the rewards that they earn now; 4,000 gradient steps on it" in line
    assert made.reward.world == made.env
    spec, rows = loop.agent.spec, np.asarray(state.memory.rows[0, :200, 0])
    motion, u = rows[:, -6:], rows[:, spec.obs : spec.obs + spec.act]
    away = np.linalg.norm(motion - np.array([0, 0, 1, 0, 0, 0]), axis=1)
    wanted = -away - 0.05 * (u**2).sum(1)
    np.testing.assert_allclose(rows[:, spec.obs + spec.act], wanted, rtol=1e-4)


def test_before_the_first_decision_it_learns_from_the_memory(source):
    """Each learner makes as many steps as asked for; half of later batches are of the new run."""
    _, loop, state, _ = begun(source, "pretrain=3", *MOTION)
    before = int(state.learners["model"].optimiser[0].count[0])
    after = loop.pretrained(state)
    assert int(after.learners["model"].optimiser[0].count[0]) == before + 3
    assert not same(after.learners["policy"].policy, saved(source)["policy"].policy)
    assert loop.agent.given == 200


def test_a_part_that_the_run_did_not_have_gets_its_networks(source):
    """Another planner, of another part of conf/."""
    made = members.load([f"run={source}", "planner=gradient"])[0].config
    assert made.controllers.full._target_.endswith("GradientController")
    assert made.controllers.full.policy == made.policy
    assert made.controllers.full.objective.critic == made.critic
    assert made.policy.hidden == [16]


def test_what_was_imagined_is_kept_only_where_nothing_changed(source, monkeypatch):
    seen = []
    monkeypatch.setattr(start, "forgotten", lambda tree: seen.append(1) or tree)
    begun(source, "total_steps=50")
    assert not seen
    begun(source, *MOTION)
    assert seen


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (["env.damping=true"], "memory: empty, since env.damping differs"),
        (["episode.delay=1", "num_envs=2"], "since episode.delay and num_envs differ"),
        ([*MOTION, "env.damping=true"], "memory: empty, since env.damping differs"),
    ],
)
def test_the_memory_is_empty_where_it_would_be_false(source, given, words):
    made, loop, state, line = begun(source, *given)
    assert words in line
    assert words in f"memory: {made.begun.memory}"
    assert not state.memory.count.any()
    assert max(loop.agent.starts().values()) == 16 + loop.agent.num_envs
    assert made.learners.policy == made.policy_learner
    if "env.damping=true" in given:
        assert made.env.damping
        assert made.reward is None or made.reward.world.damping


def test_learners_that_are_too_few_or_diverged_begin_nothing(source, monkeypatch):
    two, three = (SimpleNamespace(num_seeds=number) for number in (2, 3))
    assert start._numbers(two, two, source).tolist() == [0, 1]
    with pytest.raises(UsageError, match=r"run=.*: has 2 learners; num_seeds=3 must be as many"):
        start._numbers(three, two, source)
    meta = {"record": {"ends": [{"seed": 4}]}}
    monkeypatch.setattr(start.checkpoint, "meta", lambda folder: meta)
    with pytest.raises(UsageError, match="its learner of seed 4 diverged"):
        begun(source)


@pytest.mark.parametrize(
    "given", [{"action_repeat": 2}, {"delay": 0.05}, {"action_noise": 0.1}, {"sensor_noise": 0.1}]
)
def test_another_reward_follows_only_from_what_the_world_itself_saw(given):
    world = Pendulum()
    assert start._follows(Episode(world))
    assert not start._follows(Episode(world, **given))


def test_what_is_frozen_stays(source, warm):
    before, after = saved(source), saved(warm)
    assert same(before["policy"], after["policy"])
    assert not same(before["model"], after["model"])
    rows = rows_of(warm)
    assert [row["step"] for row in rows if "eval/policy_return" in row] == [0, 150]
    assert [row["step"] for row in rows if "model/loss" in row] == [50, 100, 150]
    assert not [row for row in rows if "sac/q" in row]
    kept, summary = (OmegaConf.load(warm / "config.yaml"), summary_of(warm))
    assert (kept.run, kept.freeze, kept.begun.step) == (str(source), ["policy"], 300)
    assert summary["run"] == str(source)
    assert summary["begun"]["remembered"] == 200


def test_it_goes_on_bit_for_bit_without_the_first_run(source, warm, tmp_path):
    first, folder = tmp_path / "first", tmp_path / "run"
    shutil.copytree(source, first)
    line = [f"run={first}", f"run_dir={folder}", "total_steps=100", "freeze=[policy]"]
    assert call_train(*line, *MOTION, "checkpoint_every=50") == 0
    shutil.rmtree(first)
    shutil.rmtree(folder / "checkpoints" / "100")
    assert call_train(f"resume={folder}", "total_steps=150") == 0
    assert interrupt.difference(folder, warm) == ""


REFUSED = [  # overrides, words of the line
    ("policy.hidden=[8]", ": its parameters do not fit: learners.policy.policy.trunk"),
    ("env.task=track", ": its parameters do not fit: "),
    ("algo=sac", ": its parameters do not fit: "),
    ("resume={source}", "run, resume: give one of them"),
    ("freeze=[polcy]", "freeze=['polcy']: the method's learners are model, policy"),
    ("pretrain=3 env.damping=true", "pretrain=3: the memory is empty"),
]


@pytest.mark.parametrize(("given", "words"), REFUSED, ids=[given for given, _ in REFUSED])
def test_what_does_not_fit_is_one_line(source, tmp_path, monkeypatch, capfd, given, words):
    monkeypatch.chdir(tmp_path)
    before = contents(source)
    assert words in refusal(capfd, f"run={source}", *given.format(source=source).split())
    assert contents(source) == before


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["env.physics=$(oc.env:HOME)"], "must be a list of KEY=VALUE"),
        (["hydra.run.dir=elsewhere"], "must be a list of KEY=VALUE"),
        (["task=../../theirs"], "must be a list of KEY=VALUE"),
        (["env._target_=subprocess.Popen"], "is no part of hybrid_rl"),
        (None, "must be a list of KEY=VALUE; train it again"),
    ],
    ids=range(5),
)
def test_the_words_of_a_run_are_judged(tmp_path, words, line):
    config_of = config.load(["task=pendulum", "algo=sac"])
    config_of.recipe = words
    folder.write(tmp_path, config_of)
    with pytest.raises(UsageError, match=line):
        members.load([f"run={tmp_path}"])


def test_where_a_run_wrote_to_is_no_word_of_the_next_one(tmp_path):
    config_of = config.load(["task=pendulum", "algo=sac"])
    config_of.recipe = ["task=pendulum", "algo=sac", "run_dir=../elsewhere"]
    folder.write(tmp_path, config_of)
    (made,) = members.load([f"run={tmp_path}"])
    assert (made.config.task, made.config.run_dir) == ("pendulum", None)
