"""An environment of this library as a Gymnasium environment, single or vectorised.

    GymnasiumEnv(env)             gymnasium.Env, for Stable-Baselines3 for example
    GymnasiumVectorEnv(env, 64)   gymnasium.vector.VectorEnv, all 64 in one compiled step

`hybrid_rl.envs.gym` registers them for `gymnasium.make`. `steps` is the time limit in decisions, at
which an episode is truncated: by default that of the package's task, 0 for none. `info` has the
environment's metrics, `success` as a bool. The vector environment resets in the step that ends an
episode (AutoresetMode.SAME_STEP): the true last observation and metrics are `infos["final_obs"]`
and `infos["final_info"]` where `infos["_final_obs"]`.

With Stable-Baselines3 on a CPU call `torch.set_num_threads(1)` first: on two busy cores 300 steps
of its SAC took 4 s with one thread and 70 s with two.

Each array that enters or leaves a compiled function costs about 2 us, more than a small environment
needs for a step. So a state is packed in one array between the calls of a single one.

Source: Gymnasium's documentation, "Env", "VectorEnv".
"""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, ClassVar

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np
from gymnasium.spaces import Box
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from jax import Array

from hybrid_rl.core.batching import of_words, where, words
from hybrid_rl.envs.gym import time_limit
from hybrid_rl.envs.mujoco.offscreen import Canvas
from hybrid_rl.envs.mujoco.scenery import pose_of, scene_of
from hybrid_rl.files.targets import part_class
from hybrid_rl.protocols import Env
from hybrid_rl.types import EnvState

Info = dict[str, Any]
FLAG = "success"  # the metric that is yes or no


def make(world: str, render_mode: str | None = None, **fields: Any) -> "GymnasiumEnv":
    """The environment of the part `world`, MODULE.CLASS; `gymnasium.make` adds the time limit.

    fields: of the environment.
    """
    return GymnasiumEnv(part_class(world)(**fields), 0, render_mode)


def make_vec(
    world: str, num_envs: int = 1, max_episode_steps: int = 0, **fields: Any
) -> "GymnasiumVectorEnv":
    """`num_envs` environments of the part `world`, MODULE.CLASS. fields: of each environment."""
    return GymnasiumVectorEnv(part_class(world)(**fields), num_envs, max_episode_steps)


def _spaces(env: Env) -> tuple[Box, Box]:
    """Observation and action space of one environment."""
    spec = env.spec
    return Box(-np.inf, np.inf, (spec.obs,)), Box(-1.0, 1.0, (spec.act,))


@cache
def _programs(env: Env) -> tuple[EnvState, Callable, Callable, Callable]:
    """Shapes of a state; reset and step on packed states, and their inverse, for all equal `env`.

    A packed state begins with what the host needs, in float32: obs, reward, terminated, metrics.
    """
    like = jax.eval_shape(env.reset, jax.random.key(0))

    def pack(state: EnvState) -> Array:
        metrics = [state.metrics[name] for name in like.metrics]
        shown = jax.tree.map(jnp.float32, [state.obs, state.reward, state.terminated, *metrics])
        same = jax.tree.map(lambda old, leaf: jnp.asarray(leaf, old.dtype), like, state)
        return words((shown, same))

    def unpack(packed: Array) -> EnvState:
        return of_words(packed[like.obs.size + 2 + len(like.metrics) :], like)

    reset = jax.jit(lambda seed: pack(env.reset(jax.random.key(seed))))
    step = jax.jit(lambda packed, action: pack(env.step(unpack(packed), action)))
    return like, reset, step, jax.jit(unpack)


class GymnasiumEnv(gymnasium.Env):
    """One environment; reset and step are one compiled call each.

    Raises:
        ValueError: if `steps` is left out and `env` is no task of this package.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array"]}

    def __init__(self, env: Env, steps: int | None = None, render_mode: str | None = None) -> None:
        self.env, self.render_mode, self._spec = env, render_mode, env.spec
        self.steps = time_limit(env) if steps is None else steps
        self.metadata = {**self.metadata, "render_fps": round(1 / env.spec.dt)}
        self.observation_space, self.action_space = _spaces(env)
        self._like, self._reset, self._step, self._unpacked = _programs(env)
        self._packed: Array  # from the first reset on
        self._canvas: Canvas | None = None

    @property
    def state(self) -> EnvState:
        """The state, as `env.step` takes it."""
        return self._unpacked(self._packed)

    def _read(self, packed: Array) -> tuple[np.ndarray, float, bool, Info]:
        """Observation [o], reward, terminated, metrics by name."""
        o = self._spec.obs
        outcome = np.asarray(packed)[: o + 2 + len(self._like.metrics)].view(np.float32)
        reward, terminated, *metrics = outcome[o:].tolist()
        info = dict(zip(self._like.metrics, metrics, strict=True))
        if FLAG in info:
            info[FLAG] = bool(info[FLAG])
        return outcome[:o].copy(), reward, bool(terminated), info

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, Info]:
        """Initial observation [o] of an episode, and its metrics."""
        super().reset(seed=seed)
        self._packed = packed = self._reset(int(self.np_random.integers(2**31)))
        self._count = 0  # steps of the episode
        obs, _, _, info = self._read(packed)
        return obs, info

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, Info]:
        """Observation [o], reward, terminated, truncated, metrics after action [m]."""
        self._packed = self._step(self._packed, np.asarray(action, np.float32))
        obs, reward, terminated, info = self._read(self._packed)
        self._count += 1
        truncated = 0 < self.steps <= self._count and not terminated
        return obs, reward, terminated, truncated, info

    def render(self) -> np.ndarray:
        """Image [480, 640, 3] (uint8) of the current state; needs no display.

        Raises:
            NoGraphicsError: if neither EGL nor OSMesa works.
            ValueError: for an environment that cannot be drawn: `scenery.scene_of` says why.
        """
        if self._canvas is None:
            self._canvas = Canvas(scene_of(self.env), smooth=False)
        return self._canvas.draw(np.asarray(pose_of(self.env)(self.state)))

    def close(self) -> None:
        """Free the resources of `render`."""
        if self._canvas is not None:
            self._canvas.close()
            self._canvas = None


class GymnasiumVectorEnv(VectorEnv):
    """`num_envs` environments, stepped together.

    Raises:
        ValueError: if `steps` is left out and `env` is no task of this package.
    """

    metadata: ClassVar[dict[str, Any]] = {"autoreset_mode": AutoresetMode.SAME_STEP}

    def __init__(self, env: Env, num_envs: int, steps: int | None = None) -> None:
        self.env, self.num_envs = env, num_envs
        self.steps = time_limit(env) if steps is None else steps
        self.single_observation_space, self.single_action_space = _spaces(env)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._reset, self._step = _vector_programs(env, self.steps)
        self._carry: tuple[EnvState, Array, Array]  # states, keys, steps so far

    def reset(
        self, *, seed: int | Sequence[int] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, Info]:
        """Initial observations [E, o], and metrics. With one seed, environment i gets seed + i."""
        each = seed + np.arange(self.num_envs) if isinstance(seed, int) else seed
        super().reset(seed=None if each is None else int(each[0]))
        seeds = self.np_random.integers(2**31, size=self.num_envs) if each is None else each
        keys = jax.vmap(lambda s: jax.random.split(jax.random.key(s)))(np.asarray(seeds))
        state = self._reset(keys[:, 0])
        self._carry = state, keys[:, 1], jnp.zeros(self.num_envs, jnp.int32)
        return np.array(state.obs), _infos(state, np.ones(self.num_envs, bool))

    def step(
        self, actions: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, Info]:
        """Observations [E, o], rewards, terminations, truncations [E], infos, after [E, m]."""
        self._carry, last, truncated = self._step(self._carry, np.asarray(actions, np.float32))
        state = self._carry[0]
        terminated, truncated = np.array(last.terminated), np.array(truncated)
        done = terminated | truncated
        infos = _infos(state, np.ones(self.num_envs, bool))
        if done.any():
            infos |= {"final_obs": np.array(last.obs), "_final_obs": done}
            infos |= {"final_info": _infos(last, done), "_final_info": done}
        return np.array(state.obs), np.array(last.reward), terminated, truncated, infos


@cache
def _vector_programs(env: Env, steps: int) -> tuple[Callable, Callable]:
    """Reset and step for all equal `env`.

    A step gives (states, keys, counts) after resets, the states before them, and truncated [E].
    """

    def step(carry: tuple[EnvState, Array, Array], actions: Array) -> tuple[Any, EnvState, Array]:
        state, keys, count = carry
        last = jax.vmap(env.step)(state, actions)
        count = count + 1
        late = count >= steps if steps > 0 else jnp.zeros_like(last.terminated)
        truncated = late & ~last.terminated
        done = last.terminated | truncated
        split = jax.vmap(jax.random.split)(keys)

        def auto_reset() -> EnvState:
            return where(done, jax.vmap(env.reset)(split[:, 0]), last)

        state = jax.lax.cond(done.any(), auto_reset, lambda: last)
        keys = jnp.where(done, split[:, 1], keys)
        return (state, keys, jnp.where(done, 0, count)), last, truncated

    return jax.jit(jax.vmap(env.reset)), jax.jit(step)


def _infos(state: EnvState, known: np.ndarray) -> Info:
    """The metrics [E] of the environments `known` [E] as Gymnasium has them, with masks."""
    infos = {name: np.where(known, x, 0) for name, x in state.metrics.items()}
    if FLAG in infos:
        infos[FLAG] = infos[FLAG].astype(bool)
    return infos | {f"_{name}": known for name in infos}
