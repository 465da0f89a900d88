"""Time limits, action repeat, and resets under any number of vmaps."""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.errors import UsageError
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import EnvState, Spec


@dataclass(frozen=True)
class Counter:
    """Counts decisions; reward 1 each; terminates at `end`."""

    end: int = 1000
    spec: Spec = Spec(obs=1, act=1, dt=0.1)

    def reset(self, key: Array) -> EnvState:
        """A count below zero, which marks a new episode."""
        start = -1.0 - jax.random.uniform(key, (1,))
        return EnvState(jnp.zeros(()), start, jnp.zeros(()))

    def step(self, state: EnvState, action: Array) -> EnvState:
        count = state.data + 1
        paid = state.replace(reward=jnp.ones(()), terminated=count >= self.end)
        return paid.replace(data=count, obs=count[None])


def roll(episode: Episode, decisions: int) -> EnvState:
    """The state after some decisions, without resets."""
    state = episode.reset(jax.random.key(0))
    for _ in range(decisions):
        state = episode.step(state, jnp.zeros(1))
    return state


def test_the_time_limit_truncates_and_the_task_terminates() -> None:
    """Never both: a terminated episode is not truncated."""
    cut = roll(Episode(Counter(), steps=5), 5)
    assert bool(cut.truncated)
    assert not bool(cut.terminated)
    ended = roll(Episode(Counter(end=5), steps=5), 5)
    assert bool(ended.terminated)
    assert not bool(ended.truncated)
    assert not bool(roll(Episode(Counter(), steps=5), 4).done)


@pytest.mark.parametrize(("end", "total"), [(1000, 6.0), (5, 5.0), (4, 4.0)])
def test_repeat_adds_rewards_until_the_end(end: int, total: float) -> None:
    """Two decisions of three repeats each; nothing counts after termination."""
    episode = Episode(Counter(end=end), steps=100, action_repeat=3)
    assert episode.spec.dt == pytest.approx(0.3)
    state = roll(episode, 2)
    assert float(state.clock.total) == total
    assert bool(state.terminated) == (end <= 6)


def test_auto_reset_works_under_two_vmaps() -> None:
    """Only environments that are done are reset, each with its own key; a branch skips none."""
    episode = Episode(Counter(), steps=3)
    keys = jax.random.split(jax.random.key(1), (2, 4))
    state = jax.vmap(jax.vmap(episode.reset))(keys)
    for _ in range(3):
        state = jax.vmap(jax.vmap(episode.step))(state, jnp.zeros((2, 4, 1)))
    done = jnp.array([[True, False, True, False], [False, False, False, True]])
    state = state.replace(truncated=done)
    auto_reset = jax.vmap(jax.vmap(episode.auto_reset))
    assert "cond[" in str(jax.make_jaxpr(auto_reset)(state, keys))
    reset = jax.jit(auto_reset)(state, keys)
    fresh = jax.vmap(jax.vmap(episode.reset))(keys)
    want = jnp.where(done[..., None], fresh.obs, state.obs)
    np.testing.assert_array_equal(reset.obs, want)
    np.testing.assert_array_equal(reset.clock.decision, jnp.where(done, 0, 3))


def test_environments_compute_in_full_precision():
    """Also if the matrix products of networks do not."""

    @dataclass(frozen=True)
    class Turned(Counter):
        def step(self, state, action):
            turn = jnp.eye(1) @ state.obs
            return super().step(state, action).replace(obs=turn)

    episode = Episode(Turned(), steps=5)
    with jax.default_matmul_precision("default"):
        state = episode.reset(jax.random.key(0))
        program = str(jax.make_jaxpr(episode.step)(state, jnp.zeros(1)))
    assert "dot_general" in program
    assert "HIGHEST" in program


@dataclass(frozen=True)
class Echo(Counter):
    """Observes the action that arrived."""

    def step(self, state: EnvState, action: Array) -> EnvState:
        return super().step(state, action).replace(obs=action)


def test_observations_have_noise_and_the_world_has_not() -> None:
    """Of the given standard deviation, new at each decision and in each episode."""
    keys = jax.random.split(jax.random.key(0), 2000)

    def observed(std: float) -> Array:
        episode = Episode(Echo(), sensor_noise=(std,))
        state = jax.vmap(episode.reset)(keys)
        each = [state.obs[:, 0]]
        for _ in range(2):
            state = jax.vmap(episode.step)(state, jnp.ones((2000, 1)))
            each.append(state.obs[:, 0])
        return jnp.stack(each)

    noise = np.asarray(observed(0.3) - observed(0.0))
    np.testing.assert_allclose(np.cov(noise), 0.09 * np.eye(3), atol=0.012)
    np.testing.assert_allclose(noise.mean(1), 0, atol=0.03)


@dataclass(frozen=True)
class Sum(Counter):
    """Adds actions to its observation, which is all that it knows; its reward is the change."""

    def step(self, state: EnvState, action: Array) -> EnvState:
        return super().step(state, action).replace(obs=state.obs + action)

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        return (after - x)[0]


def test_a_world_that_steps_from_its_observation_knows_no_noise() -> None:
    """Nor does a reward of two observations."""
    episode = Episode(Sum(), sensor_noise=0.5, reward=Sum(), action_repeat=2)
    assert float(roll(episode, 3).clock.total) == 0
    start, state = Episode(Sum()).reset(jax.random.key(0)), roll(episode, 3)
    assert float(state.clock.true_obs[0]) == float(start.obs[0]) != float(state.obs[0])


def test_actions_arrive_with_noise() -> None:
    """Clipped Gaussian noise, new at each decision and in each episode."""
    episode = Episode(Echo(), action_noise=0.5)
    state = jax.vmap(episode.reset)(jax.random.split(jax.random.key(0), 4000))
    sign, seen = np.resize([1.0, -1.0], 4000), []
    for _ in range(2):
        state = jax.vmap(episode.step)(state, 0.75 * jnp.asarray(sign, jnp.float32)[:, None])
        seen.append(sign * state.obs[:, 0])
    drawn = np.clip(0.75 + 0.5 * np.random.default_rng(0).standard_normal((2, 4000)), -1, 1)
    levels = np.linspace(0.05, 0.65, 13)
    wanted = np.quantile(drawn, levels, axis=1)
    np.testing.assert_allclose(np.quantile(seen, levels, axis=1), wanted, atol=0.06)
    assert abs(np.corrcoef(seen)[0, 1]) < 0.06
    assert np.max(seen) == 1.0


@pytest.mark.parametrize("action", [jnp.zeros(()), jnp.zeros(2), jnp.zeros((3, 1))])
def test_an_action_of_another_shape_is_refused(action: Array) -> None:
    """A world would take its first entry, or broadcast."""
    episode = Episode(Counter())
    with pytest.raises(UsageError, match=r"^the action is \[.*\]; it must be \[1\]; vmap steps"):
        episode.step(episode.reset(jax.random.key(0)), action)
