"""A policy that goes on learning in the models alone, on a point whose model is the world itself."""

from dataclasses import dataclass
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
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.rewards.known import KnownReward
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.imagined import Imagination
from hybrid_rl.training.rollout import evaluate_episodes, evaluation_keys
from hybrid_rl.types import Params

pytestmark = pytest.mark.turns(3)

WORLD = PointMass(drag=2.0)
POLICY = TanhGaussian((16,))


@dataclass(frozen=True)
class Drawn:
    """The world's dynamics, for a batch."""

    def lift(self, params: Any, obs: Array) -> Array:
        """The observation."""
        return obs

    def init(self, key: Array, spec: Any) -> tuple[()]:
        """Nothing."""
        return ()

    def draw(self, params: Any, x: Array, u: Array, noise: Array, key: Array) -> Array:
        """The next observations [B, o]."""
        return jax.vmap(WORLD.dynamics)(x, u)


@dataclass(frozen=True)
class Corner:
    """Another goal than the middle."""

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """Minus the distance to (0, 1)."""
        return -jnp.sqrt(jnp.sum((after[:2] - jnp.array([0.0, 1.0])) ** 2) + 1e-6)


EPISODE = Episode(WORLD, steps=30, reward=Corner())
MODEL: Any = Drawn()
LEARNER = ModelBased(
    POLICY,
    EnsembleQ((16,), layer_norm=True, scale=True),
    MODEL,
    KnownReward(WORLD, Corner()),
    branch_memory=320,
    batch_size=32,
    policy_learning_rate=3e-3,
    critic_learning_rate=3e-3,
    discount=0.95,
    alpha=0.01,
)
PARAMS = Params(model=(), policy=POLICY.init(jax.random.key(1), WORLD.spec))


def learned(**fields: int) -> Params:
    part = Imagination(LEARNER, MODEL, starts=64, **fields)
    return jax.jit(lambda params: part.learned(EPISODE, params, jax.random.key(0)))(PARAMS)


def test_it_gains_in_the_world() -> None:
    """Without a decision there: the mean distance of an episode is less than half of before."""
    act, keys = PolicyController(POLICY, explore=False), evaluation_keys(0, 16)
    after = learned(updates=600, critic_first=200)
    before, now = (
        evaluate_episodes(EPISODE, act, params, keys)["return"].mean() for params in (PARAMS, after)
    )
    assert now > before / 2


def test_at_first_the_critic_learns_alone() -> None:
    after = learned(updates=20, critic_first=20)
    same = jax.tree.map(np.array_equal, after.policy, PARAMS.policy)
    assert all(jax.tree.leaves(same))
