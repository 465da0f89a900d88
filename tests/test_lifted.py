"""Every part with a model whose planning state is not the observation: x = (o, o^2)."""

from dataclasses import dataclass
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from toys import Shown

from hybrid_rl.controllers.adjoint import AdjointController
from hybrid_rl.controllers.goal import GoalController
from hybrid_rl.controllers.gradient import GradientController
from hybrid_rl.controllers.guarded import GuardedController
from hybrid_rl.controllers.noisy import NoisyController
from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.controllers.refits import RefitsController
from hybrid_rl.controllers.sampling import SamplingController
from hybrid_rl.controllers.stages import StagesController
from hybrid_rl.core.domain import Box
from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.data.replay import Replay
from hybrid_rl.envs.analytic.point_mass import PointMass
from hybrid_rl.learners.bc import BehaviourCloning
from hybrid_rl.learners.ddpg import DDPG
from hybrid_rl.learners.mbpo import MBPO
from hybrid_rl.learners.model import ModelLearner
from hybrid_rl.learners.sac import SAC
from hybrid_rl.objectives.fourier_ergodic import FourierErgodic
from hybrid_rl.objectives.kl_ergodic import KLErgodic
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.objectives.target_density import TargetDensity
from hybrid_rl.objectives.utility_ergodic import UtilityErgodic
from hybrid_rl.objectives.weighted_sum import WeightedSum
from hybrid_rl.policies.regulator import Regulator
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.proposals.mixture import MixtureProposal
from hybrid_rl.proposals.noise import NoiseProposal
from hybrid_rl.proposals.policy import PolicyProposal
from hybrid_rl.rewards.network import RewardNetwork
from hybrid_rl.rewards.quadratic import QuadraticReward
from hybrid_rl.targets.mixture import Mixture
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Params, Spec

pytestmark = pytest.mark.turns(6)

WORLD = PointMass()
SPEC = WORLD.spec
N = 2 * SPEC.obs  # n


@dataclass(frozen=True)
class Squares:
    """x = (o, o^2), x' = x + W (x, u) with W learned; noise of 0.01."""

    members: ClassVar[int] = 1

    def init(self, key: Array, spec: Spec) -> dict:
        weights = 0.01 * jax.random.normal(key, (2 * spec.obs, 2 * spec.obs + spec.act))
        return {"weights": weights, "state": Scale(jnp.ones(2 * spec.obs))}

    def lift(self, params: Any, obs: Array) -> Array:
        return jnp.concatenate([obs, obs**2])

    def step(self, params: Any, x: Array, u: Array) -> Array:
        return x + params["weights"] @ jnp.concatenate([x, u])

    def observe(self, params: Any, obs: Array, next_obs: Array) -> dict:
        return params

    def loss(self, params: Any, obs: Array, action: Array, next_obs: Array, key: Array) -> Array:
        def one(obs: Array, action: Array, next_obs: Array) -> Array:
            ahead = self.step(params, self.lift(params, obs), action)
            return jnp.sum((ahead - self.lift(params, next_obs)) ** 2)

        return jax.vmap(one)(obs, action, next_obs).mean()

    def draw(self, params: Any, x: Array, u: Array, noise: Array, key: Array) -> Array:
        return jax.vmap(self.step, (None, 0, 0))(params, x, u) + 0.01 * noise


@jax.tree_util.register_dataclass
@dataclass
class Scale:
    """Standard deviations [n]."""

    scale: Array


MODEL, RNG = Squares(), np.random.default_rng(0)
SHOWN = Shown(RNG.normal(size=(20, SPEC.obs)), RNG.uniform(-1, 1, (20, SPEC.act)))
POLICY, CRITIC = TanhGaussian(hidden=(8,), normalise=True), EnsembleQ(hidden=(8,))
REWARD = RewardNetwork(hidden=(8,), ends=True)
REGULATOR = Regulator(WORLD)
BOX, TARGET = Box((0, 1), (0.0, 0.0), (1.0, 1.0)), Mixture()
RETURN = PredictedReturn(REWARD, 0.9, CRITIC, POLICY)
LEARNERS = {
    "model": ModelLearner(MODEL, REWARD, batch_size=2),
    "sac": SAC(POLICY, CRITIC, batch_size=2),
    "ddpg": DDPG(POLICY, CRITIC, batch_size=2),
    "bc": BehaviourCloning(POLICY, SHOWN, MODEL, batch_size=2, updates=1),
    "mbpo": MBPO(SAC(POLICY, CRITIC, batch_size=2), MODEL, REWARD, POLICY, steps=2),
}


def sampling(objective: Any, proposal: Any, policy: Any = None) -> SamplingController:
    """A planner by candidates."""
    return SamplingController(MODEL, objective, proposal, policy, horizon=2, samples=4)


def adjoint(objective: Any, **fields: Any) -> AdjointController:
    """A planner by gradients around the learned policy."""
    return AdjointController(MODEL, objective, POLICY, 2, **fields)


PLANNER = sampling(RETURN, PolicyProposal(POLICY), POLICY)
CONTROLLERS = {
    "actor": PolicyController(POLICY, MODEL),
    "noisy": NoisyController(PolicyController(POLICY, MODEL, explore=False), "held", hold=2),
    "sampling": PLANNER,
    "mixture": sampling(RETURN, MixtureProposal(PolicyProposal(POLICY), NoiseProposal())),
    "quadratic": sampling(PredictedReturn(QuadraticReward(WORLD)), NoiseProposal()),
    "refits": RefitsController(MODEL, RETURN, horizon=2, samples=4, elites=2, refits=2),
    "gradient": GradientController(
        MODEL, RETURN, POLICY, horizon=2, tail=1, samples=4, refined=2, iterations=1
    ),
    "adjoint": adjoint(RETURN),
    "weighted_sum": adjoint(
        WeightedSum({"a": RETURN, "b": KLErgodic(TARGET, BOX, 5)}, {"a": 1.0, "b": 0.1})
    ),
    "explorer": AdjointController(
        MODEL, KLErgodic(TARGET, BOX, 5, memory=3), REGULATOR, 2, gain=0.1, lyapunov=REGULATOR
    ),
    "fourier": adjoint(FourierErgodic(TARGET, BOX, 5, 3), gain=0.1),
    "density": adjoint(TargetDensity(TARGET, BOX), gain=0.1),
    "utility": adjoint(UtilityErgodic(MODEL, POLICY, CRITIC, 5), gain=0.1),
    "guarded": GuardedController(PLANNER, MODEL, REGULATOR, level=1.0),
    "goal": GoalController(TARGET, BOX, REGULATOR, 5, 2),
    "stages": StagesController({"a": PolicyController(POLICY, MODEL), "b": PLANNER}, (2,)),
}


def final(controller: str, *learners: str) -> tuple[Params, dict[str, Array]]:
    """The parameters after eight decisions of a controller, and the last metrics."""
    parts = {name: LEARNERS[name] for name in learners}
    agent = Agent(Episode(WORLD, 10), CONTROLLERS[controller], parts, Replay(50), random_steps=2)

    def run(key: Array) -> tuple:
        state, metrics = jax.lax.scan(agent.step, agent.init(key), jnp.arange(8))
        return agent.params(state), jax.tree.map(lambda m: m[-1], metrics)

    return jax.jit(run)(jax.random.key(0))


@pytest.fixture(scope="module")
def params() -> Params:
    """Those of the model, the reward, a policy and a critic, after a few updates."""
    return final("actor", "model", "sac")[0]


def follow(controller: Any, params: Params, decisions: int = 3) -> tuple:
    """Actions [T, m] and metrics [T] of a controller."""

    def decide(carry: tuple, key: Array) -> tuple:
        env, state = carry
        u, state, metrics = controller.act(params, state, env.obs, key)
        return (WORLD.step(env, u), state), (u, metrics)

    def run(key: Array) -> tuple:
        keys = jax.random.split(key, decisions)
        first = (WORLD.reset(key), controller.init(SPEC))
        return jax.lax.scan(decide, first, keys)[1]

    return jax.jit(run)(jax.random.key(0))


@pytest.mark.parametrize("name", CONTROLLERS)
def test_controllers_see_the_planning_state(name: str, params: Params) -> None:
    """Actions are finite and in bounds, and so are all metrics that apply; also of `greedy`."""
    controller = CONTROLLERS[name]
    greedy = controller.greedy()
    for each in [controller] if greedy == controller else [controller, greedy]:
        u, metrics = follow(each, params)
        assert np.abs(u).max() <= 1
        for metric, values in metrics.items():
            last = values[-1]
            assert np.isfinite(last) or (name == "stages" and np.isnan(last)), metric


@pytest.mark.parametrize(
    ("name", "controller"),
    [("sac", "actor"), ("ddpg", "noisy"), ("bc", "actor"), ("mbpo", "stages")],
)
def test_learners_see_the_planning_state(name: str, controller: str) -> None:
    """Networks have its size, and statistics its mean: squares are positive."""
    params, metrics = final(controller, "model", name)
    assert params.model["weights"].shape == (N, N + SPEC.act)
    assert params.policy["state"].mean.shape == params.reward["state"].mean.shape == (N,)
    assert float(params.policy["state"].mean[SPEC.obs :].min()) > 0
    first = jax.tree.leaves(params.policy["trunk"])[1]
    assert first.shape[0] == N
    learned = [value for key, value in metrics.items() if key.startswith((f"{name}/", "model/"))]
    assert learned
    assert np.isfinite(learned).all()
