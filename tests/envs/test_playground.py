"""The adapter of MuJoCo Playground, with a registry that stands in for it."""

import sys
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from flax import struct

from hybrid_rl.envs import check
from hybrid_rl.envs.adapters.playground import Playground
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Spec


@struct.dataclass
class State:
    data: Any
    obs: Any
    reward: Any
    done: Any
    metrics: dict
    info: dict


class Slider:
    """As Playground's environments: raw keys, dictionaries written in place, done where NaN."""

    observation_size, action_size, dt = {"state": (2,), "privileged_state": (9,)}, 1, 0.02

    def reset(self, key: jax.Array) -> State:
        assert key.shape == (2,)
        assert key.dtype == jnp.uint32
        x = jax.random.uniform(key, (2,))
        return State(x, self._obs(x), jnp.zeros(()), jnp.zeros(()), {"speed": x[1]}, {"steps": 0})

    def step(self, state: State, action: jax.Array) -> State:
        x = state.data + 0.02 * jnp.concatenate([state.data[1:], action])
        x = jnp.where(action[0] > 0.9, jnp.nan, x)
        state.info["steps"] = state.info["steps"] + 1
        state.metrics["speed"] = x[1]
        done = jnp.where(jnp.isnan(x).any() | (x[0] > 2), 1.0, 0.0)
        return state.replace(data=x, obs=self._obs(x), reward=x[0], done=done)

    def _obs(self, x: jax.Array) -> dict:
        return {"state": x, "privileged_state": jnp.zeros(9)}


@pytest.fixture(autouse=True)
def registry(monkeypatch):
    """Playground's registry with one environment."""

    def load(name: str, config_overrides: dict) -> Slider:
        assert config_overrides == {"impl": "jax"}
        return {"Slider": Slider}[name]()

    registry = SimpleNamespace(load=load)
    monkeypatch.setitem(sys.modules, "mujoco_playground", SimpleNamespace(registry=registry))


def test_it_passes_the_check_of_environments():
    env = Playground("Slider")
    assert env.spec == Spec(obs=2, act=1, dt=0.02)
    check(env)


def test_episodes_run_under_vmap_and_scan_and_reset_themselves():
    """Two learners with three environments; each row follows from the one before it."""
    episode = Episode(Playground("Slider"), steps=4)

    def step(state: Any, key: jax.Array) -> tuple:
        after = episode.step(state, jnp.full(1, 0.5))
        return episode.auto_reset(after, key), (state.obs, after)

    def run(key: jax.Array) -> Any:
        return jax.lax.scan(step, episode.reset(key), jax.random.split(key, 6))[1]

    keys = jax.random.split(jax.random.key(0), (2, 3))
    obs, after = jax.jit(jax.vmap(jax.vmap(run)))(keys)
    assert obs.shape == (2, 3, 6, 2)
    assert after.truncated[..., 3].all()
    assert after.truncated.sum() == 6
    np.testing.assert_allclose(after.obs[..., 1] - obs[..., 1], 0.01, atol=1e-6)
    np.testing.assert_allclose(obs[:, :, 1:4], after.obs[:, :, :3], atol=1e-6)


def test_a_state_that_is_not_a_number_ends_the_episode():
    env = Playground("Slider")
    state = env.reset(jax.random.key(0))
    after = env.step(state, jnp.ones(1))
    assert bool(after.terminated)
    assert float(after.reward) == 0
    np.testing.assert_array_equal(after.obs, state.obs)
