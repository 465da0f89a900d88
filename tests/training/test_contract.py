"""What is wrong with a part of the user's is one line that begins with its file, before a run."""

import re
from dataclasses import dataclass, field
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import hybrid_rl as hr
from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.controllers.sampling import SamplingController
from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.data.replay import Replay
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.errors import PartError, UsageError
from hybrid_rl.features.network import Network
from hybrid_rl.learners.least_squares import LeastSquares
from hybrid_rl.learners.model import ModelLearner
from hybrid_rl.learners.sac import SAC
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.models.koopman import Koopman
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.proposals.noise import NoiseProposal
from hybrid_rl.rewards.network import RewardNetwork
from hybrid_rl.settings import build as config
from hybrid_rl.training import contract


@dataclass(frozen=True)
class Line:
    """x' = x + A (x, u)."""

    def init(self, key, spec):
        return {"A": jnp.zeros((spec.obs, spec.obs + spec.act))}

    def lift(self, params, obs):
        return obs

    def step(self, params, x, u):
        return x + params["A"] @ jnp.concatenate((x, u))


@dataclass(frozen=True)
class Fit:
    """A gradient step on the error of the model."""

    model: Any = Line()
    wrong: str = ""
    data: Any = "uniform"
    owns: Any = ("model",)
    batch_size: int = 4
    batches = 1
    updates = 1
    during_random = False

    def init(self, key, spec):
        return self.model.init(key, spec), 0  # and the number of updates, of Python

    def params(self, state):
        return {"critic" if self.wrong == "params" else "model": state[0]}

    def update(self, state, params, batch, key):
        def loss(p):
            after = jax.vmap(self.model.step, (None, 0, 0))(p, batch.obs, batch.action)
            return ((after - batch.next_obs) ** 2).mean()

        error, gradient = jax.value_and_grad(loss)(state[0])
        now = jax.tree.map(lambda p, g: p - 0.1 * g, state[0], gradient), state[1] + 1
        metrics: Any = {"mine/error": error, "mine/count": state[1]}
        return {
            "alone": now,
            "longer": ((*now, now[1]), metrics),
            "type": ((now[0], now[1] + 0.5), metrics),
        }.get(self.wrong, (now, metrics))


@dataclass(frozen=True)
class Planner:
    """An action that the model finds good, in some way."""

    model: Any = Line()
    wrong: str = ""
    table: Any = field(default_factory=dict)  # has no hash

    def init(self, spec):
        return jnp.zeros(spec.act), 0

    def act(self, params, state, obs, key):
        if self.wrong == "line":
            obs = obs + jnp.zeros(7)
        u = jnp.tanh(self.model.step(params.model, obs, state[0])[:1])
        u = {"many": jnp.tile(u, 2), "whole": jnp.sign(u).astype(int)}.get(self.wrong, u)
        kept = u[:0] if self.wrong == "state" else state[0]
        return u, (kept, state[1] + 1), {"mine/u": u[0]}

    def greedy(self):
        return self


@dataclass(frozen=True)
class Wide(Line):
    """Its step returns a row."""

    def step(self, params, x, u):
        return super().step(params, x, u)[None]


class Bare(Gaussian):
    """Its parameters are the weights, and not an entry of a dict."""

    def init(self, key, spec):
        return super().init(key, spec)["weights"]


def check(planner: Any = Planner(), learner: Any = Fit()) -> None:
    learners = {"model": learner} if learner else {}
    hr.Agent(hr.Episode(Pendulum(), 20), planner, learners, Replay().within(9, 1)).check()


@dataclass(frozen=True)
class Observables:
    """z is an observation, or what else is made of it."""

    made: Any = jnp.asarray

    def init(self, key, spec):
        return {}

    def __call__(self, params, obs):
        return self.made(obs)


@dataclass(frozen=True)
class Cost:
    """J, or with `wrong` a number for each state of the path."""

    wrong: bool = False

    def init(self, spec):
        return ()

    def prepare(self, params, memory, x, u_before, key):
        return lambda path: path.x[:, 0] if self.wrong else path.x[:, 0].sum(), memory


def planning(objective: Any) -> SamplingController:
    return SamplingController(Line(), objective, NoiseProposal(), samples=4, horizon=3)


NOTHING = "nothing, init gave float32[3, 4]; both must be equal"
FAULTY = [  # a learner or a controller, the line after the file
    (Fit(data="replay"), 'Fit: data is \'replay\'; it must be "uniform" or "latest"'),
    (Fit(owns="model"), "Fit: owns is 'model'; it must be a tuple of fields of Params"),
    (Fit(wrong="params"), "Fit.params: returned ['critic']; it must be a dict of what it"),
    (Fit(wrong="alone"), f"Fit.update: returned state[0]['A'] {NOTHING}"),
    (Fit(wrong="longer"), "Fit.update: returned state[2] int32[], init gave nothing; both must"),
    (Fit(wrong="type"), "Fit.update: returned state[1] float32[], init gave int32[]; both must"),
    (Fit(Wide()), "Wide.step: returned x float32[1, 3], lift gave float32[3]; both must"),
    (Fit(Cost()), "Cost has no lift, which Fit.model needs; see protocols.Model"),
    (Cost(), "Cost has no act; see protocols.Controller"),
    (SamplingController, "SamplingController is a class; give SamplingController()"),
    (Planner(wrong="line"), "Planner.act: TypeError: add got incompatible shapes for broadcasting"),
    (Planner(wrong="many"), "Planner.act: returned action float32[2]; it must be float32[1]"),
    (Planner(wrong="whole"), "Planner.act: returned action int32[1]; it must be float32[1]"),
    (Planner(wrong="state"), "Planner.act: returned state[0] float32[0], init gave float32[1]; b"),
    (LeastSquares(Koopman(Observables(jnp.sum))), "Observables.__call__: returned z float32[]; it"),
    (LeastSquares(Koopman(Observables(list))), "Observables.__call__: returned z a list; it must"),
    (ModelLearner(Bare()), "Bare.init: returned no dict with an entry 'weights', which is learned"),
    (planning(PredictedReturn(Cost())), "Cost has no outcome, which PredictedReturn.reward needs"),
    (planning(Cost(wrong=True)), "Cost.prepare: returned J float32[6]; it must be float32[]"),
]


@pytest.mark.parametrize(("part", "words"), FAULTY, ids=[words for _, words in FAULTY])
def test_what_is_wrong_is_one_line(part, words):
    with pytest.raises(PartError) as error:
        check(**{"learner" if hasattr(part, "update") else "planner": part})
    line = str(error.value)
    assert re.match(r"\S*test_contract\.py:\d+: |hybrid_rl\.", line)
    assert words in line
    assert "\n" not in line


WHOLE = LeastSquares(Koopman(Network((7,))))
UNTRAINED = PredictedReturn(RewardNetwork((4,)))
SOFT = SAC(TanhGaussian((8,)), EnsembleQ((8,)))
OTHER = r"policy=TanhGaussian: PolicyController acts by it, but \S+ is float32\[4\] in it and float"
UNFIT = [  # a controller, a learner, how the line begins
    (Planner(), WHOLE, r"features\.coordinates=\[7\]: must be some"),  # by the library itself
    (planning(UNTRAINED), Fit(), "PredictedReturn: reward=RewardNetwork: no learner trains"),
    (Planner(), None, "Planner: model=Line: no learner trains it"),
    (PolicyController(TanhGaussian((4,))), SOFT, OTHER),
]


@pytest.mark.parametrize(("planner", "learner", "words"), UNFIT, ids=range(4))
def test_parts_that_do_not_fit_together_are_named(planner, learner, words):
    """Flax's own error names a parameter and no part, in a traceback."""
    with pytest.raises(ValueError, match=f"^{words}"):
        check(planner, learner)


def test_a_model_of_another_form_than_its_learner_trains_is_named_in_a_run():
    """That of the learner of the policy, which learns in the model."""
    other = "policy_learner.model={_target_: hybrid_rl.models.gaussian.Gaussian, hidden: [4]}"
    words = r"^model=Gaussian: ModelBased learns with it, but \S+ is float"
    with pytest.raises(UsageError, match=words):
        config.build(config.load([other]))


@pytest.mark.parametrize("algo", ["sac", "nn_mppi", "deterministic_mpc"])
def test_parts_of_the_library_keep_the_contract_too(algo, monkeypatch):
    """A run spares itself their traces."""
    run = config.build(config.load(["task=pendulum", f"algo={algo}"]))
    for name in ("of_user", "has_users"):
        monkeypatch.setattr(contract, name, lambda part: True)
    run.agent.check(run.controllers.values())


@dataclass(frozen=True)
class Near:
    """Less the distance to the nearest of several goals."""

    def reward_of(self, x, u, after):
        goals = jnp.eye(3)
        return -jnp.square(goals - x).sum(1).min()


def test_a_reward_subtracts_as_numpy_does():
    with jax.numpy_rank_promotion("allow"):  # which the tests of the library forbid
        assert hr.Episode(Pendulum(), 20, reward=Near()).spec.obs == 3


def test_a_right_method_learns_and_acts_with_python_numbers_in_its_states(tmp_path):
    agent = hr.Agent(hr.Episode(Pendulum(), 20), Planner(), {"model": Fit()}, Replay())
    result = hr.train(agent, total_steps=40, run_dir=tmp_path / "run", log_every=20, progress=False)
    (curve,) = result.curves("mine/count")
    assert curve.each[0, -1] == np.arange(15, 35).mean()  # from the fifth decision on, of 20 to 39
    policy = result.load().policy()
    assert policy(np.array([1.0, 0.0, 0.0])).shape == (1,)
