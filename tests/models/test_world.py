"""Planning on the world itself, against MuJoCo C stepped by hand."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from jax import Array
from toys import Grid

from hybrid_rl.controllers.sampling import SamplingController
from hybrid_rl.envs.cartpole import Cartpole
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.errors import UsageError
from hybrid_rl.models.world import World
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.rewards.world import WorldReward
from hybrid_rl.run.saved import Trained
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import EnvState, Params, Path, Spec

T, K, LAMBDA, GAMMA = 4, 3, 0.5, 0.9


def by_hand(state: EnvState, u: float) -> list[float]:
    """Rewards of T decisions of two steps each with constant u, from MuJoCo C."""
    model = mjcf.load("cartpole.xml")
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = state.data.qpos, state.data.qvel
    rewards = []
    for _ in range(T):
        reward = 0.0
        for _ in range(2):
            data.ctrl[:] = u
            mujoco.mj_step(model, data)
            reward += np.cos(data.qpos[1])
        rewards.append(reward)
    return rewards


def test_plans_are_those_of_mujoco() -> None:
    """Action and planned return, from a state whose velocities are not zero.

    Without the world the planner cannot act.
    """
    env: Any = Cartpole(physics="native")
    world = Episode(env, steps=100, action_repeat=2)
    state = world.step(world.reset(jax.random.key(0)), jnp.full(1, 0.7))
    controller = SamplingController(
        World(world),
        PredictedReturn(WorldReward(), GAMMA),
        Grid(),
        horizon=T,
        samples=K,
        temperature=LAMBDA,
    )
    act = jax.jit(lambda state: controller.act(Params(world=state), first, state.obs, key))
    first, key = controller.init(world.spec), jax.random.key(1)
    action, _, metrics = act(state)
    each = np.array([by_hand(state, k / K) for k in range(K)]) @ GAMMA ** np.arange(T)
    w = np.exp((each - each.max()) / LAMBDA)
    w /= w.sum()
    np.testing.assert_allclose(action, [w @ np.arange(K) / K], rtol=1e-3)
    np.testing.assert_allclose(metrics["planner/planned_return"], w @ each, rtol=1e-3)
    trained = Trained("cartpole", world, {"full": controller}, Params(), (0,), 0, ())
    with pytest.raises(UsageError, match=r"mode=full: plans from the state of the world"):
        trained.policy()


@dataclass(frozen=True)
class Counter:
    """x' = x + u, r = x', o = (x, x); ends above 2."""

    spec = Spec(obs=2, act=1, dt=0.1)

    def state(self, x: Array) -> EnvState:
        """The state at x []."""
        return EnvState(x, jnp.stack((x, x)), x, x > 2)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """One decision."""
        return self.state(state.data + action[0])


@dataclass(frozen=True)
class Last:
    """A critic of value 10 x, and a policy without parameters."""

    def mean(self, params: Any, x: Array) -> Array:
        """No action."""
        return jnp.zeros(1)

    def value(self, params: Any, x: Array, u: Array) -> Array:
        """10 x."""
        return 10 * x[0]


@pytest.mark.parametrize(("u", "want"), [(0.5, 1 + 1.5 + 2 + 20), (2.0, 2.5), (1.0, 1.5 + 2.5)])
def test_nothing_is_paid_after_the_end(u: float, want: float) -> None:
    """The reward of the last decision counts, later ones and the critic's value do not."""
    model: Any = World(Counter())
    x = [Counter().state(jnp.float32(0.5))]
    for _ in range(3):
        x.append(model.step((), x[-1], jnp.full(1, u)))
    path = Path(jax.tree.map(lambda *leaves: jnp.stack(leaves), *x), jnp.full((3, 1), u))
    last: Any = Last()
    objective = PredictedReturn(WorldReward(), 1.0, last, last)
    assert float(objective.reward_to_go(Params(), path)[0]) == pytest.approx(want)
