"""Evaluations of episodes, and policies of finished runs."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.run.saved import Trained
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import advance, begin, evaluate_episodes, rollout
from hybrid_rl.types import EnvState, Params, Spec


@dataclass(frozen=True)
class Walk:
    """The sum of the actions; the episode ends with success at a sum of 3 or more."""

    reports: bool = True
    spec: Spec = Spec(obs=1, act=1, dt=0.1)

    def reset(self, key: Array) -> EnvState:
        return self._state(jnp.zeros(()))

    def step(self, state: EnvState, action: Array) -> EnvState:
        return self._state(state.data + action[0])

    def _state(self, at: Array) -> EnvState:
        metrics = {"success": (at >= 3).astype(jnp.float32)} if self.reports else {}
        return EnvState(at, at[None], at, at >= 3, jnp.zeros((), bool), metrics, {})


class Draws:
    """The action is 0.5 or 1, drawn once per episode."""

    def init(self, spec: Spec) -> Array:
        return jnp.float32(-1)

    def act(self, params: Params, state: Array, obs: Array, key: Array) -> tuple:
        drawn = 0.5 + 0.5 * jax.random.bernoulli(key)
        state = jnp.where(state < 0, drawn, state)
        return state[None], state, {}


def test_an_evaluation_has_returns_and_successes() -> None:
    """A roll-out is the same episode by the same draws; an evaluation goes on where it paused."""
    keys, episode = jax.random.split(jax.random.key(0), 16), Episode(Walk(), steps=5)
    got = evaluate_episodes(episode, Draws(), Params(), keys)
    success = np.asarray(got["success"])
    assert set(success) == {0.0, 1.0}
    wanted = np.where(success, 6, 7.5)  # 1 + 2 + 3 and nothing after; 0.5 + 1 + ... + 2.5
    np.testing.assert_array_equal(got["return"], wanted)
    one = jax.vmap(lambda key: rollout(episode, Draws(), Params(), key, 5))
    np.testing.assert_array_equal(one(keys).clock.total[:, -1], wanted)
    more = jax.jit(partial(advance, episode, Draws(), Params()))
    paused = more(begin(episode, Draws(), keys), jnp.int32(2))
    assert set(np.asarray(paused[0].clock.decision)) == {2}
    np.testing.assert_array_equal(more(paused, jnp.int32(9))[0].clock.total, wanted)
    silent = Episode(replace(Walk(), reports=False), steps=5)
    assert list(evaluate_episodes(silent, Draws(), Params(), keys)) == ["return"]


@dataclass(frozen=True)
class Counts:
    """The action is the count of decisions in this episode, plus the observation."""

    def init(self, spec: Spec) -> Array:
        return jnp.zeros(())

    def act(self, params: Params, state: Array, obs: Array, key: Array) -> tuple:
        return (state + obs) * params.policy, state + 1, {}


def run_of(controller: Any) -> Trained:
    """A run of two learners; the second one's actions have the opposite sign."""
    params = Params(policy=jnp.array([1.0, -1.0]))
    return Trained("walk", Episode(Walk()), {"full": controller}, params, (3, 4), 100, ())


def test_a_trained_policy_acts_from_observations() -> None:
    """Of one environment and of many; each environment has its own state for an episode."""
    policy = run_of(Counts()).policy()
    got = [policy(np.array([0.5])) for _ in range(3)]
    np.testing.assert_array_equal(got, [[0.5], [1.5], [2.5]])
    policy.reset()
    np.testing.assert_array_equal(policy(np.zeros((2, 1))), [[0], [0]])
    np.testing.assert_array_equal(policy(np.zeros((2, 1))), [[1], [1]])
    policy.reset(np.array([True, False]))
    np.testing.assert_array_equal(policy(np.zeros((2, 1))), [[0], [2]])
    other = run_of(Counts()).policy(seed=4)
    np.testing.assert_array_equal(other(np.array([0.5])), [-0.5])


def test_a_trained_policy_draws_for_each_environment_and_decision() -> None:
    draws, again, other = (run_of(Draws()).policy(key=key) for key in (0, 0, 1))
    first = draws(np.zeros((32, 1)))
    assert 16 < first.sum() < 32
    np.testing.assert_array_equal(again(np.zeros((32, 1))), first)
    assert (other(np.zeros((32, 1))) != first).any()
    draws.reset()
    assert (draws(np.zeros((32, 1))) != first).any()


def test_a_trained_policy_refuses_bad_arguments() -> None:
    policy = run_of(Counts()).policy()
    for wrong in (np.zeros(2), np.zeros((1, 1, 1)), 0.0):
        with pytest.raises(ValueError, match=r"it must be \[1\] or \[N, 1\]"):
            policy(wrong)
    policy(np.zeros((2, 1)))
    for wrong in (np.zeros((3, 1)), np.array([[0.0], [np.nan]])):  # of three worlds after two
        with pytest.raises(ValueError, match="obs"):
            policy(wrong)
