"""A Gymnasium environment, which is no JAX function: it steps on the host, between two programs.

    External(id="Hopper-v5")                      of Gymnasium's registry, or MODULE:ID
    External(make="my_module:MyEnv")              a class, or a function without arguments
    External(make=MyEnv, kwargs={"mass": 2.0})    the same from Python

Actions u in [-1, 1] are scaled to the bounds of the action space. An observation of dictionaries
or tuples is flattened by Gymnasium's wrapper, in the order of the sorted keys. Methods that learn
their model train on it; those that plan on the true dynamics do not.

Source: Gymnasium's documentation, "Env", "AutoresetMode".
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, partial
from importlib import import_module
from typing import Any, NamedTuple, NoReturn

import gymnasium
import jax.numpy as jnp
import numpy as np
from gymnasium.spaces import Box
from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv
from gymnasium.wrappers import FlattenObservation
from jax import Array

from hybrid_rl.errors import UsageError, WorldError, gist, in_user_code
from hybrid_rl.types import EnvState, Spec

Numbers = np.ndarray | Array
KINDS = "its spaces must be numbers: actions a Box with finite bounds; observations of any form "
KINDS += "that Gymnasium flattens (Box, Discrete, Dict, Tuple)"
HUGE = 100_000  # entries; an image has as many


@dataclass(frozen=True)
class External:
    """An environment that Gymnasium makes, of which one copy is made to read its spaces.

    Raises:
        UsageError: if it cannot be made, or its spaces are none that a method can use.
    """

    id: str = ""
    make: str | Callable[..., gymnasium.Env] = ""  # in place of an id
    kwargs: Mapping[str, Any] | None = None  # of the environment
    dt: float | None = None  # [s] between decisions; None: what the environment says
    processes: bool = False  # one for each copy; pays where a step takes 1 ms or more
    timeout_s: float | None = None  # [s] for a step, with processes; then the run ends

    def __post_init__(self) -> None:
        """Check the fields, and the spaces."""
        if not (self.id or self.make):
            raise UsageError("env.id: give an id of Gymnasium, or env.make=MODULE:CLASS")
        if self.timeout_s is not None and not (self.timeout_s > 0 and self.processes):
            raise UsageError(
                f"env.timeout_s={self.timeout_s}: must be above 0, with env.processes=true"
            )
        object.__setattr__(self, "kwargs", Items(self.kwargs or {}))
        _ = self.known

    @property
    def name(self) -> str:
        """What messages call it."""
        return str(getattr(self.make, "__name__", self.make) or self.id)

    @property
    def known(self) -> "Known":
        """What one copy of the environment declares."""
        return _known(self)

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""
        return self.known.spec

    def reset(self, key: Array) -> EnvState:
        """A state with zeros for the observation; the loop on the host puts the true one."""
        zero, no = jnp.zeros(()), jnp.zeros((), bool)
        return EnvState((), jnp.zeros(self.spec.obs), zero, no, no)

    def step(self, state: EnvState, action: Array) -> NoReturn:
        """No JAX function.

        Raises:
            UsageError: always.
        """
        raise UsageError(
            f"{self.name}: steps on the host, so no method can plan on it; choose one that learns "
            "its model, such as algo=hybrid_stochastic, nn_mppi or sac"
        )

    def one(self, render_mode: str | None = None) -> gymnasium.Env:
        """A copy of the environment, with flat observations and without a time limit of its own."""
        given: dict[str, Any] = dict(self.kwargs or {}) | (
            {"render_mode": render_mode} if render_mode else {}
        )
        if not self.make:
            options: dict[str, Any] = {"disable_env_checker": True, "max_episode_steps": -1}
            env = gymnasium.make(self.id, **options, **given)
        else:
            env = imported(self.make)(**given)
            if not isinstance(env, gymnasium.Env):
                raise UsageError(
                    f"env.make={self.name}: returns {env!r}, which is no gymnasium.Env"
                )
        if isinstance(env.observation_space, Box) and len(env.observation_space.shape) == 1:
            return env
        return FlattenObservation(env)

    def copies(
        self, seeds: Sequence[int], steps: int, repeat: int = 1, render_mode: str | None = None
    ) -> "Copies":
        """One copy for each seed; steps: decisions until the time limit of each."""
        return Copies(self, seeds, steps, repeat, render_mode)


class Known(NamedTuple):
    """What an environment declares."""

    spec: Spec
    steps: int | None  # the time limit [steps of the environment]
    space: Box  # of actions


class Outcome(NamedTuple):
    """One decision in N environments."""

    obs: Numbers  # [N, o] float32, the true last ones where an episode ended
    reward: Numbers  # [N] float32
    terminated: Numbers  # [N] bool
    truncated: Numbers  # [N] bool: only the time limit ended the episode
    following: Numbers  # [N, o] float32, those of a new episode where one ended


class Copies:
    """N copies of an environment, which step side by side."""

    def __init__(
        self,
        env: External,
        seeds: Sequence[int],
        steps: int,
        repeat: int,
        render_mode: str | None = None,
    ) -> None:
        self.env, self.seeds, self.steps, self.repeat = env, list(map(int, seeds)), steps, repeat
        self.render_mode = render_mode
        self.decisions = np.zeros(len(self.seeds), int)  # of the episode
        self._obs = np.zeros((len(self.seeds), env.spec.obs), np.float32)

    @cached_property
    def _vector(self) -> Any:
        makers = [partial(self.env.one, self.render_mode) for _ in self.seeds]
        options: dict[str, Any] = {"autoreset_mode": AutoresetMode.DISABLED}
        if self.env.processes:
            return AsyncVectorEnv(makers, context="spawn", **options)
        return SyncVectorEnv(makers, **options)

    def reset(self) -> np.ndarray:
        """The first observations [N, o]; the first call seeds the environments."""
        self.decisions[:] = 0
        obs, _ = self._call("reset", lambda: self._vector.reset(seed=self.seeds))
        self.seeds = [None for _ in self.seeds]  # a seed at each reset would repeat one start
        self._obs = self._observed("reset", obs)
        return self._obs

    def step(self, u: np.ndarray) -> Outcome:
        """Actions u [N, m] in [-1, 1]; where an episode ends, another one begins.

        Raises:
            WorldError: if the environment raises an error, gives NaN, or takes too long.
        """
        space = self.env.known.space
        share = (np.clip(np.asarray(u, np.float32), -1, 1) + 1) / 2
        low, high = space.low.ravel(), space.high.ravel()
        actions = (low + share * (high - low)).reshape(-1, *space.shape).astype(space.dtype)
        reward = np.zeros(len(u), np.float32)
        for i in range(self.repeat):
            obs, now, ended, cut, _ = self._call("step", lambda: self._stepped(actions))
            reward += np.asarray(now, np.float32)
            if i + 1 < self.repeat and (ended | cut).any():
                break
        obs = self._observed("step", obs)
        if not np.isfinite(reward).all():
            raise WorldError(f"{self.env.name}: step: gives a reward that is not finite")
        self.decisions += 1
        cut = (np.asarray(cut) | (self.decisions >= self.steps)) & ~np.asarray(ended)
        done = ended | cut
        return Outcome(obs, reward, np.array(ended), cut, self._next(obs, done))

    def picture(self) -> np.ndarray:
        """The first environment [height, width, 3] (uint8), with render_mode="rgb_array".

        Raises:
            WorldError: if it gives none.
        """
        found = self._call("render", lambda: self._vector.render()[0])
        if not (isinstance(found, np.ndarray) and found.ndim == 3):
            raise WorldError(f"{self.env.name}: render: gives no picture, but {type(found)}")
        return found[: found.shape[0] // 2 * 2, : found.shape[1] // 2 * 2]

    def _next(self, obs: np.ndarray, done: np.ndarray) -> np.ndarray:
        """The observations [N, o] that the next decision sees."""
        if not done.any():
            return obs
        self.decisions[done] = 0
        options = {"reset_mask": np.array(done)}
        fresh, _ = self._call("reset", lambda: self._vector.reset(options=options))
        return np.where(done[:, None], self._observed("reset", fresh), obs)

    def _stepped(self, actions: np.ndarray) -> tuple:
        if not self.env.processes:
            return self._vector.step(actions)
        self._vector.step_async(actions)
        return self._vector.step_wait(self.env.timeout_s)

    def _call(self, method: str, call: Callable[[], Any]) -> Any:
        """The result of a method of the environments; an error names the user's line."""
        try:
            return call()
        except UsageError:
            raise
        except TimeoutError as error:
            self.close(terminate=True)
            line = f"{self.env.name}: {method}: took longer than env.timeout_s"
            raise WorldError(f"{line}={self.env.timeout_s}") from error
        except Exception as error:
            line = in_user_code(error) or gist(error)
            raise WorldError(f"{self.env.name}: {method}: {line}") from error

    def _observed(self, method: str, obs: Any) -> np.ndarray:
        """A copy of the observations, which an environment may overwrite, as float32 [N, o]."""
        copy, wanted = np.array(obs, np.float32), (len(self.decisions), self.env.spec.obs)
        if copy.shape != wanted:
            line = f"gives observations of shape {list(copy.shape)}; its space says {list(wanted)}"
            raise WorldError(f"{self.env.name}: {method}: {line}")
        if not np.isfinite(copy).all():
            entry = int(np.argwhere(~np.isfinite(copy))[0, 1])
            raise WorldError(f"{self.env.name}: {method}: entry {entry} of obs is not finite")
        return copy

    def close(self, **options: Any) -> None:
        """End the environments, and their processes."""
        if "_vector" in vars(self):
            vars(self).pop("_vector").close(**options)


class Items(dict):
    """Settings of an environment: a dictionary that is not changed, with a hash."""

    def __hash__(self) -> int:  # type: ignore[override]
        return hash(repr(sorted(self.items(), key=repr)))


def imported(make: Any) -> Callable[..., Any]:
    """The function or class that `MODULE:NAME` names; what is no text stays as it is.

    Raises:
        UsageError: if it cannot be imported.
    """
    if not isinstance(make, str):
        return make
    module, colon, name = make.partition(":")
    if not colon:
        raise UsageError(f"env.make={make}: give MODULE:CLASS or MODULE:FUNCTION")
    try:
        return getattr(import_module(module), name)
    except Exception as error:  # whatever the user's module does
        line = in_user_code(error) or str(error)
        raise UsageError(f"env.make={make}: cannot be imported ({line})") from error


@cache
def _known(env: External) -> Known:
    try:
        one = env.one()
        one.reset(seed=0)
    except UsageError:
        raise
    except Exception as error:
        key = "make" if env.make else "id"
        line = in_user_code(error) or gist(error)
        raise UsageError(f"env.{key}={env.name}: {line}") from error
    space, obs = one.action_space, one.observation_space
    bounded = isinstance(space, Box) and bool(np.isfinite([space.low, space.high]).all())
    if not (bounded and isinstance(obs, Box) and np.prod(obs.shape) < HUGE):
        raise UsageError(f"{env.name}: has actions {space} and observations {obs}; {KINDS}")
    dt = env.dt or getattr(one.unwrapped, "dt", None)
    dt = dt or 1 / (one.metadata.get("render_fps") or np.inf)
    if not dt:
        raise UsageError(f"{env.name}: does not say its time step; give env.dt [s]")
    limit = None if env.make else gymnasium.spec(env.id.rpartition(":")[2]).max_episode_steps
    one.close()
    assert isinstance(space, Box)
    sizes = int(np.prod(obs.shape)), int(np.prod(space.shape))
    return Known(Spec(*sizes, float(dt)), limit, space)
