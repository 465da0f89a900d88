"""An environment of this library as a Gymnasium environment, single or vectorised.

    GymnasiumEnv(env)             gymnasium.Env, for Stable-Baselines3 for example
    GymnasiumVectorEnv(env, 64)   gymnasium.vector.VectorEnv, all 64 in one compiled step

`steps` is the time limit in decisions, at which an episode is truncated; 0 for none. The vector
environment resets in the step that ends an episode (AutoresetMode.SAME_STEP): the true last
observation is `infos["final_obs"]` where `infos["_final_obs"]`.

With Stable-Baselines3 on a CPU call `torch.set_num_threads(1)` first: on two busy cores 300 steps
of its SAC took 4 s with one thread and 70 s with two.

Source: Gymnasium's documentation, "Env", "VectorEnv".
"""

from collections.abc import Sequence
from functools import partial
from typing import Any, ClassVar

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np
from gymnasium.spaces import Box
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from jax import Array

from hybrid_rl.envs.mujoco.offscreen import Canvas, check_drawable
from hybrid_rl.protocols import Env
from hybrid_rl.types import EnvState


def _spaces(env: Env) -> tuple[Box, Box]:
    """Observation and action space of one environment."""
    return (
        Box(-np.inf, np.inf, (env.spec.obs,), np.float32),
        Box(-1.0, 1.0, (env.spec.act,), np.float32),
    )


class GymnasiumEnv(gymnasium.Env):
    """One environment; reset and step are one compiled call each."""

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array"]}

    def __init__(self, env: Env, steps: int = 0, render_mode: str | None = None) -> None:
        self.env, self.steps, self.render_mode = env, steps, render_mode
        self.metadata = {**self.metadata, "render_fps": round(1 / env.spec.dt)}
        self.observation_space, self.action_space = _spaces(env)
        self._reset, self._step = jax.jit(env.reset), jax.jit(partial(_packed_step, env))
        self._canvas: Canvas | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Initial observation [o] of an episode."""
        super().reset(seed=seed)
        key = jax.random.key(int(self.np_random.integers(2**31)))
        self._state, self._count = self._reset(key), 0
        return np.array(self._state.obs), {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Observation [o], reward, terminated, truncated, info after action [m]."""
        self._state, out = self._step(self._state, np.asarray(action, np.float32))
        out = np.array(out)
        self._count += 1
        truncated = 0 < self.steps <= self._count
        return out[:-2], float(out[-2]), bool(out[-1]), truncated, {}

    def render(self) -> np.ndarray:
        """Image [480, 640, 3] (uint8) of the current state; needs no display.

        Raises:
            NoGraphicsError: if neither EGL nor OSMesa works.
            ValueError: for an environment without `scene` and `pose`.
        """
        if self._canvas is None:
            check_drawable(self.env)
            self._canvas = Canvas(self.env.scene())
        return self._canvas.draw(np.asarray(self.env.pose(self._state)))

    def close(self) -> None:
        """Free the resources of `render`."""
        if self._canvas is not None:
            self._canvas.close()
            self._canvas = None


def _packed_step(env: Env, state: EnvState, action: Array) -> tuple[EnvState, Array]:
    """The next state, and [obs, reward, terminated] [o + 2] packed for one copy to the host."""
    state = env.step(state, action)
    return state, jnp.concatenate((state.obs, jnp.stack((state.reward, state.terminated))))


class GymnasiumVectorEnv(VectorEnv):
    """`num_envs` environments, stepped together."""

    metadata: ClassVar[dict[str, Any]] = {"autoreset_mode": AutoresetMode.SAME_STEP}

    def __init__(self, env: Env, num_envs: int, steps: int = 0) -> None:
        self.env, self.num_envs, self.steps = env, num_envs, steps
        self.single_observation_space, self.single_action_space = _spaces(env)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._reset = jax.jit(jax.vmap(env.reset))
        self._step = jax.jit(partial(_autoreset_step, env, steps))

    def reset(
        self,
        *,
        seed: int | Sequence[int] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Initial observations [E, o]. With one seed, environment i gets seed + i."""
        first = seed if seed is None or isinstance(seed, int) else int(seed[0])
        super().reset(seed=first)
        if seed is None:
            seeds = self.np_random.integers(2**31, size=self.num_envs)
        elif isinstance(seed, int):
            seeds = seed + np.arange(self.num_envs)
        else:
            seeds = np.asarray(seed)
        keys = jax.vmap(lambda s: jax.random.split(jax.random.key(s)))(seeds)
        self._state, self._keys = self._reset(keys[:, 0]), keys[:, 1]
        self._count = jnp.zeros(self.num_envs, jnp.int32)
        return np.array(self._state.obs), {}

    def step(
        self, actions: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Observations [E, o], rewards, terminations, truncations [E], infos, after [E, m]."""
        carry = (self._state, self._keys, self._count)
        carry, last, truncated = self._step(carry, np.asarray(actions, np.float32))
        self._state, self._keys, self._count = carry
        terminated, truncated = np.array(last.terminated), np.array(truncated)
        done, everywhere = terminated | truncated, np.ones(self.num_envs, bool)
        infos = {k: np.array(v) for k, v in last.metrics.items()}
        infos |= {f"_{k}": everywhere for k in last.metrics}
        if done.any():
            infos |= {"final_obs": np.array(last.obs), "_final_obs": done}
        obs, reward = np.array(self._state.obs), np.array(last.reward)
        return obs, reward, terminated, truncated, infos


def _autoreset_step(
    env: Env, steps: int, carry: tuple[EnvState, Array, Array], actions: Array
) -> tuple[tuple[EnvState, Array, Array], EnvState, Array]:
    """(states, keys, counts) after resets; the states before them; truncated [E]."""
    state, keys, count = carry
    last = jax.vmap(env.step)(state, actions)
    count = count + 1
    truncated = (count >= steps) & ~last.terminated if steps else jnp.zeros_like(last.terminated)
    done = last.terminated | truncated

    def auto_reset() -> EnvState:
        first = jax.vmap(env.reset)(split[:, 0])
        pick = jax.vmap(lambda d, a, b: jax.tree.map(lambda x, y: jnp.where(d, x, y), a, b))
        return pick(done, first, last)

    split = jax.vmap(jax.random.split)(keys)
    state = jax.lax.cond(done.any(), auto_reset, lambda: last)
    keys = jnp.where(done, split[:, 1], keys)
    return (state, keys, jnp.where(done, 0, count)), last, truncated
