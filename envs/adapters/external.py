"""A Gymnasium environment, which is no JAX function: it steps on the host, beside a program.

    External(id="Hopper-v5")                      of Gymnasium's registry, or MODULE:ID
    External(make="my_module:MyEnv")              a class, or a function without arguments
    External(make=MyEnv, kwargs={"mass": 2.0})    the same from Python

Actions u in [-1, 1] are scaled to the bounds of the action space. An observation of dictionaries
or tuples is flattened by Gymnasium's wrapper, in the order of the sorted keys. Methods that learn
their model train on it; those that plan on the true dynamics do not.

Source: Gymnasium's documentation, "Env", "AutoresetMode".
"""

import multiprocessing
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any, NamedTuple

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np
from gymnasium.spaces import Box, Dict, Space, flatdim, flatten
from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv
from gymnasium.wrappers import FlattenObservation, TimeLimit
from jax import Array

from hybrid_rl.envs.adapters.unstepped import Made, import_named, registered
from hybrid_rl.envs.trial import check
from hybrid_rl.errors import FAULTS, UsageError, WorldError, blame, kind_of
from hybrid_rl.fields import Positive, part
from hybrid_rl.protocols import Constraint, Goal
from hybrid_rl.protocols.contract import of_user
from hybrid_rl.types import Spec

Numbers = np.ndarray | Array
FLAGS = ("is_success", "success")  # in infos: what others call a success
SILENT = 100  # level of Gymnasium's log
ACTIONS = "they must be a Box with finite bounds, of one number or more"
FORMS = "they must be numbers in a form that Gymnasium flattens: Box, Discrete, Dict, Tuple"
PICTURE = "for a video, give it `def __init__(self, render_mode=None)` and a method `render` that "
PICTURE += "returns a picture, an array [height, width, 3] of uint8"
GIVES = {"reset": ("obs", "info"), "step": ("obs", "reward", "terminated", "truncated", "info")}
DT = 'add env.dt=0.05, the seconds of a decision, or metadata = {"render_fps": 20} to its class'


@part
class External(Made):
    """An environment that Gymnasium makes; one copy is made, reset and stepped, to know it."""

    id: str = ""  # in place of `make`
    dt: Positive | None = None  # [s] between decisions; None: what the environment says
    processes: bool = False  # one for each copy; pays where a step takes 1 ms or more
    timeout_s: Positive | None = None  # [s] for a step, in processes; then the run ends

    def __post_init__(self) -> None:
        if not (self.id or self.make):
            raise UsageError("env.id: give an id of Gymnasium, or env.make=MODULE:CLASS")
        super().__post_init__()
        _ = self.known

    @property
    def name(self) -> str:
        """What messages call it."""
        return super().name or self.id

    @property
    def known(self) -> "Known":
        """What one copy of the environment declares."""
        return _known(self)

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""
        return self.known.spec

    @property
    def quantities(self) -> Callable[[Array], dict[str, Array]]:
        """The function of that name of its class, if it has one; goals and constraints need it."""
        if self.known.quantities is None:
            raise AttributeError("quantities")
        return self.known.quantities

    @property
    def apart(self) -> bool:
        """Whether each copy has a process of its own."""
        return self.processes or self.timeout_s is not None

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """The least and the greatest action [m], in the environment's units."""
        space = self.known.space
        return space.low.ravel(), space.high.ravel()

    @property
    def parts(self) -> str:
        """The entries of an observation in their order, if it is a Dict: gear [3], goal [2]."""
        space = self.known.seen
        parts = space.items() if isinstance(space, Dict) else ()
        return ", ".join(f"{name} [{flatdim(each)}]" for name, each in parts)

    def flat(self, obs: Any) -> np.ndarray:
        """What a policy sees, [o], of an observation as the environment returns it."""
        return np.asarray(flatten(self.known.seen, obs))

    def one(self, render_mode: str | None = None) -> gymnasium.Env:
        """A copy of the environment, with flat observations and without a time limit of its own."""
        mode = {} if render_mode is None else {"render_mode": render_mode}
        given: dict[str, Any] = {**(self.kwargs or {}), **mode}
        if not self.make:
            options: dict[str, Any] = {"disable_env_checker": True, "max_episode_steps": -1}
            return FlattenObservation(gymnasium.make(registered(self.id), **options, **given))
        return FlattenObservation(import_named(self.make)(**given))


class Outcome(NamedTuple):
    """One decision in N environments."""

    obs: Numbers  # [N, o] float32, the true last ones where an episode ended
    reward: Numbers  # [N] float32, before a constraint's price
    violated: Numbers  # [N] float32: 1 where the decision violates the constraint, else 0
    terminated: Numbers  # [N] bool
    truncated: Numbers  # [N] bool: only the time limit ended the episode
    following: Numbers  # [N, o] float32, those of a new episode where one ended


@dataclass
class Copies:
    """N copies of an environment, which step side by side.

    `goal` pays each decision, `limit` judges it, both once.
    """

    env: External
    seeds: Sequence[int | None]
    steps: int  # decisions until the time limit of each
    repeat: int = 1
    render_mode: str | None = None
    goal: Goal | None = None
    limit: Constraint | None = None
    success: np.ndarray | None = field(default=None, init=False)  # [N], if infos say so

    def _one(self) -> gymnasium.Env:
        """A copy that takes decisions, of which `steps` make an episode."""
        return TimeLimit(Repeated(self.env.one(self.render_mode), self.repeat), self.steps)

    @cached_property
    def _vector(self) -> Any:
        makers = [self._one for _ in self.seeds]
        if self.env.apart:
            return AsyncVectorEnv(makers, context="spawn", autoreset_mode=AutoresetMode.DISABLED)
        return SyncVectorEnv(makers, copy=False, autoreset_mode=AutoresetMode.DISABLED)

    @cached_property
    def _judge(self) -> Callable[..., tuple[Array | None, Array]]:
        """What the goal pays, None without one, and whether the limit is violated."""
        goal, limit = self.goal, self.limit

        def one(x: Array, u: Array, after: Array) -> tuple[Array | None, Array]:
            paid = None if goal is None else goal.reward_of(x, u, after)
            return paid, jnp.float32(0 if limit is None else limit.excess(x, u, after) > 0)

        return jax.jit(jax.vmap(one))

    def reset(self) -> np.ndarray:
        """The first observations [N, o]; the first call seeds the environments."""
        self._obs = self._observed("reset", lambda: self._vector.reset(seed=self.seeds))[0]
        self.seeds = [None for _ in self.seeds]  # a seed at each reset would repeat one start
        return self._obs

    def step(self, u: np.ndarray) -> Outcome:
        """Actions u [N, m] in [-1, 1]; where an episode ends, another one begins."""
        low, high = self.env.bounds
        u = np.clip(np.asarray(u, np.float32), -1, 1)
        space = self.env.known.space
        actions = (low + (u + 1) / 2 * (high - low)).reshape(-1, *space.shape)
        actions = (np.rint(actions) if space.dtype.kind in "iu" else actions).astype(space.dtype)
        obs, paid, ended, cut, infos = self._observed("step", lambda: self._stepped(actions))
        violated = np.zeros(len(obs), np.float32)
        if self.goal is not None or self.limit is not None:
            given = jax.device_put((self._obs, u, obs), jax.devices("cpu")[0])
            by_goal, violated = jax.device_get(self._judge(*given))
            paid = paid if by_goal is None else by_goal
        if not np.isfinite(paid).all():
            payer = f"{self.env.name}: step" if self.goal is None else type(self.goal).__name__
            raise WorldError(f"{payer}: gives a reward that is not finite")
        flags = [np.asarray(infos[name]) for name in FLAGS if name in infos]
        self.success = flags[0].astype(bool).reshape(len(paid), -1).any(1) if flags else None
        self._obs = obs
        if (done := ended | cut).any():
            options = {"reset_mask": done}
            fresh = self._observed("reset", lambda: self._vector.reset(options=options))[0]
            self._obs = np.where(done[:, None], fresh, obs)
        paid = np.asarray(paid, np.float32)
        return Outcome(obs, paid, violated, ended, cut & ~ended, self._obs)

    def picture(self) -> np.ndarray:
        """The first environment [height, width, 3] (uint8), with render_mode="rgb_array"."""
        found = self._call("render", lambda: self._vector.render()[0])
        if not (isinstance(found, np.ndarray) and found.ndim == 3):
            line = f"{self.env.name}: render: returns {type(found).__name__}"
            raise WorldError(f"{line}; {PICTURE}")
        return found[: found.shape[0] // 2 * 2, : found.shape[1] // 2 * 2]

    def close(self) -> None:
        """End the environments, and their processes."""
        if "_vector" in vars(self):
            vars(self).pop("_vector").close()

    def _stepped(self, actions: np.ndarray) -> tuple:
        """What the vector's `step` returns, within the limit of time."""
        if not self.env.apart:
            return self._vector.step(actions)
        self._vector.step_async(actions)
        limit = self.env.timeout_s
        return self._vector.step_wait(None if limit is None else limit * self.repeat)

    def _observed(self, method: str, call: Callable[[], Any]) -> list[Any]:
        """What `call` of a method returns, with a copy of the observations as float32 [N, o]."""
        obs, *rest = self._call(method, call)
        obs = np.array(obs, np.float32)  # the environment may overwrite its own
        if not np.isfinite(obs).all():
            entry = int(np.argwhere(~np.isfinite(obs))[0, 1])
            raise WorldError(f"{self.env.name}: {method}: entry {entry} of obs is not finite")
        return [obs, *rest]

    def _call(self, method: str, call: Callable[[], Any]) -> Any:
        """The result of a method of the environments; an error is one line."""
        before = gymnasium.logger.min_level
        if self.env.apart:  # Gymnasium's log has the traceback of what it raises again
            gymnasium.logger.min_level = SILENT
        try:
            return call()
        except UsageError:
            raise
        except FAULTS as error:
            line = f"{blame(error)}; {PICTURE}" if method == "render" else blame(error)
            late = isinstance(error, multiprocessing.TimeoutError)
            if late or (self.env.apart and isinstance(error, EOFError | ConnectionError)):
                self._kill()
                line = "its process ended, as where there is no memory left"
                line = f"took longer than env.timeout_s={self.env.timeout_s}" if late else line
            raise WorldError(f"{self.env.name}: {method}: {line}") from error
        finally:
            gymnasium.logger.min_level = before

    def _kill(self) -> None:
        """End all processes, also those that are stopped or do not answer."""
        if (vector := vars(self).pop("_vector", None)) is None:  # a process failed to start
            return
        for process in vector.processes:
            process.kill()
            process.join()
        vector.closed = True  # its own `close` would ask them


class Repeated(gymnasium.Wrapper):
    """Takes each action for several steps, or until its episode ends; their rewards are added."""

    def __init__(self, env: gymnasium.Env, repeat: int) -> None:
        super().__init__(env)
        self.repeat = repeat

    def step(self, action: Any) -> Any:
        """The last step, with the reward of all."""
        paid = 0.0
        for _ in range(self.repeat):
            obs, reward, ended, cut, info = self.env.step(action)
            paid += float(reward)
            if ended or cut:
                break
        return obs, paid, ended, cut, info


class Known(NamedTuple):
    """What an environment declares."""

    spec: Spec
    steps: int | None  # the time limit [steps of the environment]
    space: Box  # of actions
    seen: Space  # of observations, as the environment returns them
    quantities: Callable[[Array], dict[str, Array]] | None  # of an observation, flat, in JAX


@cache
def _known(env: External) -> Known:
    """What one copy declares."""
    try:
        one = env.one()
        fault, dt = _fault(one), env.dt or _time_step(one)  # some declare it in a reset
        fault = fault or ("" if dt else f"does not say its time step; {DT}")
    except UsageError:
        raise
    except FAULTS as error:
        one, dt, fault = None, 0.0, blame(error)
    if fault or one is None:
        raise UsageError(f"env.{'make' if env.make else 'id'}={env.name}: {fault}")
    space, obs, seen = one.action_space, one.observation_space, one.env.observation_space
    assert isinstance(space, Box)
    limit = None
    if not env.make and one.spec is not None:
        limit = gymnasium.spec(one.spec.id).max_episode_steps  # of the newest version of an env.id
    elif one.has_wrapper_attr("_max_episode_steps"):
        limit = one.get_wrapper_attr("_max_episode_steps")  # of a TimeLimit
    one.close()
    measured = getattr(one.unwrapped, "quantities", None)
    return Known(Spec(flatdim(obs), flatdim(space), dt), limit, space, seen, measured)


def _fault(one: gymnasium.Env) -> str:
    """What its spaces, one reset and one step show to be wrong; empty: nothing."""
    first = one.env.reset(seed=0)  # some declare their spaces there
    space, obs, seen = one.action_space, one.observation_space, one.env.observation_space
    if not (isinstance(space, Box) and flatdim(space) and space.is_bounded()):
        return f"has actions {space}; {ACTIONS}"
    if not (isinstance(obs, Box) and flatdim(obs)):
        return f"has observations {seen}; {FORMS}"
    action = (space.low / 2 + space.high / 2).astype(space.dtype)
    for (method, must), given in zip(GIVES.items(), (first, one.env.step(action)), strict=True):
        if not isinstance(given, tuple) or len(given) != len(must):
            return f"{method}: returns {kind_of(given)}; it must be ({', '.join(must)})"
        if (size := np.asarray(flatten(seen, given[0])).size) != (needs := flatdim(obs)):
            return f"{method}: returns obs of {size} numbers; its space has {needs}, {seen}"
    return ""


def _time_step(one: gymnasium.Env) -> float:
    """The seconds between decisions, by `dt` of the environment or its `render_fps`; 0: neither."""
    with suppress(*FAULTS):  # there is neither, or it is no number
        dt = float(getattr(one.unwrapped, "dt", None) or 1 / one.metadata["render_fps"])
        if 0 < dt < np.inf:
            return dt
    return 0.0


def check_world(env: Any) -> None:
    """Check a world of the user's."""
    if of_user(env):
        check(env)
