"""A trained run on rewards that it was not trained on, from its folder and from a policy's file."""

import json
from dataclasses import replace
from functools import partial
from pathlib import Path

import jax
import numpy as np
import pytest
from tiny import call_command, finished, only_line, refusal, run

from hybrid_rl import demonstrate, evaluate
from hybrid_rl.controllers.gradient import GradientController
from hybrid_rl.controllers.sampling import SamplingController
from hybrid_rl.errors import UsageError
from hybrid_rl.rewards.network import RewardNetwork
from hybrid_rl.run.retarget import retargeted
from hybrid_rl.run.saved import Trained, load, read
from hybrid_rl.settings import build
from hybrid_rl.settings.groups import options
from scripts import new_goals

pytestmark = pytest.mark.turns(3)

METHOD = ["algo=hybrid_stochastic", "learning=replay"]
AT = ["reward=aim", "reward.quantity=position", "reward.target=0.5"]
SMALL = ["planner.horizon=3", "planner.tail=2", "planner.samples=6", "planner.refined=2"]
main = partial(call_command, demonstrate.main)


# A run of a few decisions with models, policy and critic.
trained = finished("task=cartpole", *METHOD, "episode.steps=20", "eval_modes=[policy]")


@pytest.fixture(scope="module")
def known(trained: Path) -> Trained:
    """Its learners, read one time."""
    return load(trained)


def test_the_environment_pays_and_the_planner_plans(known: Trained) -> None:
    """Returns of an episode are those of the new reward, along the cart's own positions."""
    goal = retargeted(known, [*AT, *SMALL])
    both, alone = goal.controllers["full"], goal.controllers["planner"]
    assert isinstance(both, GradientController)
    assert isinstance(alone, GradientController)
    assert (both.horizon, both.tail, alone.policy) == (3, 2, None)
    assert goal.controllers["policy"] == known.controllers["policy"]
    got = evaluate.evaluate(goal, "full", 2)["return"]
    assert got.shape == (len(goal.seeds), 2)
    assert (got > -20 * (3 + 0.05)).all()
    assert (got < 0).all()


def test_several_goals_in_one_program_have_the_returns_of_each(known: Trained) -> None:
    """scripts.new_goals, whose goal is an argument of its program, beside `evaluate`."""
    names = ("aim position 0.5", "aim speed 1.0")
    goals = {name: retargeted(known, new_goals.overrides(name)) for name in names}
    first = goals[names[0]]
    rewards = {name: each.episode.reward for name, each in goals.items()}
    got = new_goals.measured(first, rewards, first.controllers["policy"], 2)
    for name, each in goals.items():
        expected = evaluate.evaluate(each, "policy", 2)["return"].mean(1)
        np.testing.assert_allclose(got[name], expected, rtol=1e-5)


def test_another_planner_keeps_the_reward_and_its_critic(known: Trained) -> None:
    """planner=NAME alone is for the reward of the training."""
    was, now = known, retargeted(known, ["planner=gradient", *SMALL])
    assert now.episode == was.episode
    planned, planner = was.controllers["full"], now.controllers["full"]
    assert isinstance(planned, SamplingController)
    assert isinstance(planner, GradientController)
    assert planner.objective == planned.objective


def test_keys_of_the_planner_of_the_run_change_alone(known: Trained) -> None:
    """Also those that its file left at their defaults, as in a class of the user's."""
    was, now = known.controllers, retargeted(known, ["planner.horizon=2", "planner.rest=0.5"])
    assert now.controllers["full"] == replace(was["full"], horizon=2, rest=0.5)
    assert [now.controllers[mode] == was[mode] for mode in ("policy", "planner")] == [True, True]
    assert now.episode == known.episode
    for wrong, words in (
        ("planner.horizn=2", "planner: SamplingController.* unexpected keyword argument 'horizn'"),
        ("planner.horizon=many", r"planner\.horizon=many: must be a whole number"),
        ("planner.horizon=0", r"planner\.horizon=0: must be"),
    ):
        with pytest.raises(UsageError, match=f"^{words}"):
            retargeted(known, [wrong])
    with pytest.raises(UsageError, match="is a key of planner=NAME"):
        retargeted(read("halfcheetah"), ["planner.horizon=2"])


@pytest.mark.parametrize("name", options("planner"))
def test_a_planner_has_one_name_and_one_key_in_training_and_after_it(known: Trained, name) -> None:
    """Nothing of the method's own planner is left."""
    words = [f"planner={name}", "planner.horizon=2"]
    run = build.build(build.load(["task=cartpole", *METHOD, *words]))
    one, other = run.controllers["full"], retargeted(known, words).controllers["full"]
    assert {*run.config.planner} == {"_target_", *vars(one)}
    assert (type(one), one.horizon, other.horizon) == (type(other), 2, 2)


PUSH = """from dataclasses import dataclass
import jax.numpy as jnp

@dataclass(frozen=True)
class Push:
    objective: object
    def init(self, spec): return ()
    def act(self, params, state, obs, key): return jnp.zeros(2), state, {}
"""


def test_a_planner_of_the_users_is_checked_before_it_acts(known, tmp_path, monkeypatch) -> None:
    """As before a run that trains: for its methods, and for what they return."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "planner").mkdir()
    gives = r"Push\.act: returned action float32\[2\]; it must be float32\[1\]"
    for name, more, words in (
        ("push", "", r"Push has no greedy; see protocols\.Controller"),
        ("push_on", "    def greedy(self): return self\n", gives),
    ):
        (tmp_path / f"{name}.py").write_text(PUSH + more)
        (tmp_path / "planner" / "own.yaml").write_text(f"_target_: {name}.Push\n")
        with pytest.raises(UsageError, match=rf"^{name}\.py:\d+: {words}"):
            retargeted(known, [*AT, "planner=own"], tmp_path)


def test_a_policy_has_proposals_for_any_planner() -> None:
    """Its file has none; they are its roll-outs at several strengths."""
    goal = ["reward=speed", "planner.samples=4", "planner.horizon=2"]
    planner = retargeted(read("halfcheetah"), [*goal, "planner=sampling"]).controllers["full"]
    assert planner.proposal.strengths == (1.0, 0.8, 0.6, 0.4, 0.2)


def test_a_price_that_was_learned_is_not_charged_again(known: Trained) -> None:
    """The learned reward has it: of the same limit, and for the reward of the training."""
    run, near = known, ["constraint=position", "constraint.most=0.5"]
    paid = retargeted(run, [*near, "planner=gradient", *SMALL])
    assert not paid.controllers["full"].priced
    for more, priced in (
        ([], True),
        (["constraint=position", "constraint.most=0.5", "constraint.chance=0.1"], True),
        (["constraint=position", "constraint.most=0.4"], False),
        (AT, False),
    ):
        planner = retargeted(paid, [*more, "planner=gradient", *SMALL]).controllers["full"]
        assert planner.priced == priced
        assert planner.constraint is not None


def test_a_file_with_models_plans_as_the_run_does(trained, known, tmp_path, capsys) -> None:
    """Up to the 16 bits of its weights; without them it has a policy alone."""
    file, bare = tmp_path / "both.npz", tmp_path / "bare.npz"
    assert main(f"run={trained}", f"policy={file}", "models=true") == 0
    assert main(f"run={trained}", f"policy={bare}") == 0
    assert "policy and models of" in capsys.readouterr().out
    obs, of_file = np.array([0.1, 0.0, 0.9, 0.1, 0.0], np.float32), read(str(file))
    one, other = (retargeted(each, [*AT, *SMALL]) for each in (known, of_file))
    assert one.controllers["full"] == other.controllers["full"]
    goals = [retargeted(each, ["planner=gradient", *SMALL]) for each in (known, of_file)]
    assert all(goal.controllers["full"].objective.critic for goal in goals)
    np.testing.assert_allclose(*(goal.policy()(obs) for goal in goals), atol=0.02)
    unaware = retargeted(read(str(bare)), AT)
    assert set(unaware.controllers) == {"full", "policy"}
    assert unaware.notes[-1].endswith(f"what acts knows nothing of {' '.join(AT)}")
    assert goals[1].notes == of_file.notes


def test_a_file_holds_the_learner_that_is_asked_for(tmp_path, capfd) -> None:
    """Its own parameters and seed; one that the run does not have is one line."""
    folder, file = tmp_path / "run", tmp_path / "second.npz"
    run(folder, "task=cartpole", "algo=sac", "seed=3", "num_seeds=2")
    assert main(f"run={folder}", f"policy={file}", "learner=4") == 0
    was, now = load(folder), read(str(file))
    assert now.seeds == (4,)
    second = jax.tree.map(lambda leaf: leaf[1:], was.params.policy)
    jax.tree.map(np.testing.assert_array_equal, now.params.policy, second)
    capfd.readouterr()
    assert main(f"run={folder}", f"policy={file}", "learner=5") == 2
    assert "seed=5: choose one of 3, 4" in only_line(capfd)


def test_a_file_holds_the_reward_and_the_constraint_of_its_run(tmp_path) -> None:
    """So its evaluation is that of the run; each can be replaced."""
    folder, file = tmp_path / "run", tmp_path / "aimed.npz"
    run(folder, "task=cartpole", "algo=sac", *AT, "constraint=torque", "constraint.most=0.01")
    assert main(f"run={folder}", f"policy={file}") == 0
    was, now = (evaluate.evaluate(each, "policy", 2) for each in (load(folder), read(str(file))))
    jax.tree.map(np.testing.assert_array_equal, now, was)
    assert now["violations"].min() > 0
    other = retargeted(read(str(file)), ["constraint=torque", "constraint.most=1.0"]).episode
    assert (other.constraint.most, other.reward) == (1.0, load(folder).episode.reward)


def test_evaluate_names_the_goal(trained: Path, capsys) -> None:
    """In its output and in the file's name."""
    given = [f"run={trained}", "episodes=2", "mode=policy", *AT, "env.reward=cos"]
    assert call_command(evaluate.main, *given) == 0
    assert "reward=aim, reward.quantity=position" in capsys.readouterr().out
    (file,) = trained.glob("evaluation_policy_reward=aim*.json")
    assert json.loads(file.read_text())["changes"]["reward.target"] == "0.5"


def test_a_return_that_is_not_finite_is_one_line_and_no_file(trained, capfd, monkeypatch) -> None:
    monkeypatch.setattr(evaluate, "evaluate", lambda *_: {"return": np.array([[1.0, np.nan]])})
    given = (f"run={trained}", "mode=policy", "reward=speed")
    line = "a return is not finite: see reward=speed and the controller's actions"
    assert line in refusal(capfd, *given, of=evaluate.main)
    assert not [*trained.glob("evaluation_policy_reward=speed*")]


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["run={}", "reward=fame"], "reward=fame: unknown; choose one of aim, height, level"),
        (["run={}", "reward.target=2"], "reward.target=2: is a key of reward=NAME; give that with"),
        (["run={}", "episode.sensor_noise=a"], "episode.sensor_noise=a: must be a number"),
        (["run={}", "reward=speed", "reward.tarket=2"], "did you mean reward.target?"),
        (["run={}", "reward=level"], "reward.world=Cartpole: has no pitch, only position, speed, "),
        (["run={}", "planner=fast"], "hybrid_rl: planner=fast: unknown; choose one of adjoint"),
        (["policy=cartpole", "reward=speed\nx: 1"], "reward=speed x: 1: cannot be read; write key"),
        (["policy=cartpole", "reward=speed", "planner.horizon=3"], "=3: there is no learned model"),
    ],
)
def test_a_mistake_is_one_line(trained: Path, known: Trained, words, line, capfd, monkeypatch):
    """Of a run, and of a policy without models."""
    monkeypatch.setattr("hybrid_rl.run.saved.load", lambda folder: known)
    assert line in refusal(capfd, *(word.format(trained) for word in words), of=evaluate.main)


@pytest.mark.parametrize("word", ["planner=gradient", "constraint=speed"])
def test_a_shipped_planner_maximises_the_learned_reward(word: str) -> None:
    """Without a goal, by the network in the file: there is no critic."""
    now = retargeted(read("halfcheetah"), [word])
    objective = now.controllers["full"].objective
    assert isinstance(objective.reward, RewardNetwork)
    assert (objective.critic, now.episode.reward) == (None, None)
