"""An environment of MuJoCo Playground as an environment of this library.

It is JAX inside, so every method trains many learners of it in one program. The raw environment is
taken, without Playground's wrapper for training: episodes, resets and time limits are those of
`Episode`. Of a dictionary of observations `state` is used; what only a critic may see is not.

Playground marks an episode as done where a number is NaN, too. Then the last observation and a
reward of 0 stand in for it, and the episode terminates.

Source: MuJoCo Playground's `mjx_env.MjxEnv`; task=playground needs the extra `bench`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.envs.adapters.unstepped import Items
from hybrid_rl.errors import UsageError, install
from hybrid_rl.types import EnvState, Spec


@dataclass(frozen=True)
class Playground:
    """The environment `name` of Playground's registry."""

    name: str
    config: Mapping[str, Any] | None = None  # its own settings; {"impl": "jax"} unless it says warp

    def __post_init__(self) -> None:
        object.__setattr__(self, "config", Items({"impl": "jax"} | dict(self.config or {})))
        _ = self.spec

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""
        return _spec(self)

    def reset(self, key: Array) -> EnvState:
        """The first state of an episode."""
        state = _loaded(self).reset(jax.random.key_data(key))
        return EnvState(*self._parts(state), terminated=state.done > 0)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after action [m]."""
        before = state.data  # Playground writes into its dictionaries
        before = before.replace(info=dict(before.info), metrics=dict(before.metrics))
        after = _loaded(self).step(before, action)
        types = jax.tree.map(jnp.result_type, state.data)
        after = jax.tree.map(lambda x, kind: jnp.asarray(x, kind), after, types)
        data, obs, reward = self._parts(after)
        sound = jnp.isfinite(obs).all() & jnp.isfinite(reward)
        return state.replace(
            data=data,
            obs=jnp.where(sound, obs, state.obs),
            reward=jnp.where(sound, reward, 0.0),
            terminated=(after.done > 0) | ~sound,
        )

    def _parts(self, state: Any) -> tuple[Any, Array, Array]:
        """Data, observation [o] and reward [] of Playground's state."""
        obs = state.obs["state"] if isinstance(state.obs, Mapping) else state.obs
        return state, obs.ravel().astype(jnp.float32), state.reward.astype(jnp.float32)


@cache
def _loaded(env: Playground) -> Any:
    try:
        registry = import_module("mujoco_playground").registry
    except ImportError as error:
        line = f"task=playground needs MuJoCo Playground ({error}); {install('bench')}"
        raise UsageError(line) from error
    return registry.load(env.name, config_overrides=dict(env.config or {}))


@cache
def _spec(env: Playground) -> Spec:
    """Playground traces a reset to know the size of an observation."""
    loaded = _loaded(env)
    size = loaded.observation_size
    size = size["state"] if isinstance(size, Mapping) else size
    return Spec(int(np.prod(size)), loaded.action_size, float(loaded.dt))
