"""A policy that goes on learning in the models alone; the model of a point is its world."""

from dataclasses import dataclass, replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.envs.analytic.point_mass import PointMass
from hybrid_rl.learners.model_based import ModelBased
from hybrid_rl.models.exact import Exact
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.rewards.known import KnownReward
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.imagined import Imagination
from hybrid_rl.training.rollout import evaluate_episodes, evaluation_keys
from hybrid_rl.types import Params

WORLD = PointMass(drag=2.0)
POLICY = TanhGaussian((16,))


@dataclass(frozen=True)
class Drawn(Exact):
    """The world's dynamics, also for a batch."""

    def draw(self, params: Any, x: Array, u: Array, noise: Array, key: Array) -> Array:
        return jax.vmap(self.world.dynamics)(x, u)


@dataclass(frozen=True)
class Corner:
    """Another goal than the middle."""

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """Minus the distance to (0, 1)."""
        return -jnp.sqrt(jnp.sum((after[:2] - jnp.array([0.0, 1.0])) ** 2) + 1e-6)


EPISODE = Episode(WORLD, steps=30, reward=Corner())
MODEL: Any = Drawn(WORLD)
CRITIC = EnsembleQ((16,), normalise=True, scale=True)
FIELDS: dict[str, Any] = {"branch_memory": 320, "batch_size": 32, "discount": 0.95, "alpha": 0.01}
FIELDS |= dict.fromkeys(("policy_learning_rate", "critic_learning_rate"), 3e-3)
LEARNER = ModelBased(POLICY, CRITIC, MODEL, KnownReward(WORLD, Corner()), **FIELDS)
PARAMS = Params(model=(), policy=POLICY.init(jax.random.key(1), WORLD.spec))


def learned(updates: int, critic_first: int) -> tuple[Params, Array]:
    part = Imagination(LEARNER, updates, critic_first, starts=64, walk=20, decisions=30)
    return jax.jit(lambda params: part.learned(EPISODE, params, jax.random.key(0)))(PARAMS)


def test_it_gains_in_the_world() -> None:
    """Without a decision there: the mean distance of an episode is less than half of before."""
    act, keys = PolicyController(POLICY, explore=False), evaluation_keys(0, 16)
    after, new = learned(updates=600, critic_first=200)
    assert new
    before, now = (
        evaluate_episodes(EPISODE, act, params, keys)["return"].mean() for params in (PARAMS, after)
    )
    assert now > before / 2


@dataclass(frozen=True)
class Ending:
    """Episodes that go on with a chance."""

    chance: float

    def outcome(self, params: Any, x: Array, u: Array, after: Array) -> tuple[Array, Array]:
        """No reward, and the logit of the end."""
        return jnp.zeros(()), jnp.log(jnp.float32(1 / self.chance - 1))


@pytest.mark.parametrize("chance", [1.0, 0.9])
def test_returns_in_the_model_are_those_of_the_world(chance: float) -> None:
    """The model is the world, and it has one member; what comes after an end pays nothing."""
    reward = KnownReward(WORLD, Corner(), Ending(chance))
    part = Imagination(replace(LEARNER, reward=reward), decisions=30, episodes=4)
    starts = jax.vmap(EPISODE.reset)(jax.random.split(jax.random.key(2), 4))

    def step(state, _):
        u = jax.vmap(POLICY.mean, (None, 0))(PARAMS.policy, state.obs)
        state = jax.vmap(EPISODE.step)(state, u)
        return state, state.reward

    rewards = jax.jit(lambda: jax.lax.scan(step, starts, length=30)[1])()
    wanted = (chance ** np.arange(30) @ np.asarray(rewards)).mean()
    np.testing.assert_allclose(part.returns(PARAMS, starts.obs), [wanted], rtol=1e-5)


def test_a_walk_stays_where_the_model_knows_no_next_state() -> None:
    """Learners get no start that is not finite."""

    @dataclass(frozen=True)
    class Lost(Drawn):
        def draw(self, params: Any, x: Array, u: Array, noise: Array, key: Array) -> Array:
            """NaN right of the middle."""
            return jnp.where(x[:, :1] > 0, jnp.nan, super().draw(params, x, u, noise, key))

    model: Any = Lost(WORLD)
    x = jnp.array([[0.5, 0.0, 0.0, 0.0], [-9.0, 0.0, 0.0, 0.0]])
    part = Imagination(replace(LEARNER, model=model), walk=5)
    states = np.asarray(part.walked(PARAMS, x, jax.random.key(0)).obs).reshape(5, 2, -1)
    np.testing.assert_array_equal(states[:, 0], np.tile(x[0], (5, 1)))
    assert np.isfinite(states).all()
    assert (states[1:, 1] != states[:-1, 1]).any(1).all()


def test_at_first_the_critic_learns_alone() -> None:
    """So the policy is the same, which is no gain."""
    after, new = learned(updates=20, critic_first=20)
    assert not new
    same = jax.tree.map(np.array_equal, after.policy, PARAMS.policy)
    assert all(jax.tree.leaves(same))
