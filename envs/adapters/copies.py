"""Copies of a Gymnasium environment that step side by side, and what a decision led to."""

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property, partial
from multiprocessing.connection import wait
from typing import Any, NamedTuple

import gymnasium
import numpy as np
from gymnasium.vector import AsyncVectorEnv, AutoresetMode
from jax import Array

from hybrid_rl.errors import FAULTS, UsageError, WorldError, blame

Numbers = np.ndarray | Array
SILENT = 100  # level of Gymnasium's log
FLAGS = ("is_success", "success")  # in infos: what others call a success
PICTURE = "for a video, give it `def __init__(self, render_mode=None)` and a method `render` that "
PICTURE += "returns a picture, an array [height, width, 3] of uint8"


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
        env: Any,
        seeds: Sequence[int],
        steps: int,
        repeat: int,
        render_mode: str | None = None,
    ) -> None:
        self.env, self.seeds, self.steps, self.repeat = env, list(map(int, seeds)), steps, repeat
        self.render_mode = render_mode
        self.success: np.ndarray | None = None  # [N], if the last decision's infos say so
        self.decisions = np.zeros(len(self.seeds), int)  # of the episode
        self._obs = np.zeros((len(self.seeds), env.spec.obs), np.float32)

    @cached_property
    def _vector(self) -> Any:
        one = partial(self.env.one, self.render_mode)
        one = one if self.repeat == 1 else partial(Repeated, one, self.repeat)
        if not self.env.processes:
            return InTurn([one() for _ in self.seeds])
        makers = [partial(Located, one) for _ in self.seeds]
        return AsyncVectorEnv(makers, context="spawn", autoreset_mode=AutoresetMode.DISABLED)

    @cached_property
    def _bounds(self) -> tuple[np.ndarray, np.ndarray, tuple[int, ...], Any]:
        """Bounds of actions: the lowest [m], their width [m]; shape and dtype of the space."""
        space = self.env.known.space
        low, high = self.env.bounds
        return low, high - low, space.shape, space.dtype

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
        low, width, shape, kind = self._bounds
        share = (np.maximum(np.minimum(np.asarray(u, np.float32), 1), -1) + 1) / 2
        actions = (low + share * width).reshape(-1, *shape)
        actions = (np.rint(actions) if kind.kind in "iu" else actions).astype(kind)
        obs, paid, ended, cut, infos = self._call("step", lambda: self._stepped(actions))
        obs, reward = self._observed("step", obs), np.asarray(paid, np.float32)
        if not np.isfinite(reward).all():
            raise WorldError(f"{self.env.name}: step: gives a reward that is not finite")
        self.decisions += 1
        given = [np.asarray(infos[name]) for name in FLAGS if name in infos]
        self.success = given[0].astype(bool).reshape(len(paid), -1).any(1) if given else None
        cut = (np.asarray(cut) | (self.decisions >= self.steps)) & ~np.asarray(ended)
        done = ended | cut
        return Outcome(obs, reward, np.array(ended), cut, self._next(obs, done))

    def picture(self) -> np.ndarray:
        """The first environment [height, width, 3] (uint8), with render_mode="rgb_array"."""
        found = self._call("render", lambda: self._vector.render()[0])
        if not (isinstance(found, np.ndarray) and found.ndim == 3):
            line = f"{self.env.name}: render: returns {type(found).__name__}"
            raise WorldError(f"{line}; {PICTURE}")
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
        limit = self.env.timeout_s
        return self._vector.step_wait(None if limit is None else limit * self.repeat)

    def _call(self, method: str, call: Callable[[], Any]) -> Any:
        """The result of a method of the environments; an error names the user's line."""
        try:
            with self._quiet():
                return call()
        except UsageError:
            raise
        except multiprocessing.TimeoutError as error:
            self._kill()
            line = f"{self.env.name}: {method}: took longer than env.timeout_s"
            raise WorldError(f"{line}={self.env.timeout_s}") from error
        except FAULTS as error:
            line = str(error) if self.env.processes else blame(error)
            if self.env.processes and isinstance(error, EOFError | ConnectionError):
                line = self._lost()
            raise WorldError(f"{self.env.name}: {method}: {line}") from error

    def _lost(self) -> str:
        """End all processes after one of them; how that one ended."""
        if "_vector" not in vars(self):
            return "a process did not begin"
        processes = self._vector.processes
        ended = wait([process.sentinel for process in processes], timeout=1)
        for each in (each for each in processes if each.sentinel in ended):
            each.join(timeout=1)  # the sentinel is closed a moment before there is an exit code
        codes = [each.exitcode for each in processes if each.exitcode is not None]
        self._kill()
        line = f"its process ended with exit code {codes[0] if codes else 'unknown'}"
        return f"{line}, as after out of memory" if set(codes) == {-signal.SIGKILL} else line

    def _kill(self) -> None:
        """End all processes, also those that are stopped or do not answer."""
        vector = vars(self).pop("_vector")
        for process in vector.processes:
            process.kill()
            process.join()
        vector.closed = True  # its own `close` would ask them

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

    def close(self) -> None:
        """End the environments, and their processes."""
        if "_vector" in vars(self):
            with self._quiet():
                vars(self).pop("_vector").close()

    @contextmanager
    def _quiet(self) -> Iterator[None]:
        """Gymnasium's log without what it says of processes: what it warns of is raised, too."""
        before = gymnasium.logger.min_level
        if self.env.processes:
            gymnasium.logger.min_level = SILENT
        try:
            yield
        finally:
            gymnasium.logger.min_level = before


class InTurn:
    """Environments in this process: of Gymnasium's SyncVectorEnv what `Copies` needs.

    That one also copies spaces and gathers infos, which takes as long as a half-cheetah's step.
    """

    def __init__(self, envs: list[gymnasium.Env]) -> None:
        self.envs = envs
        self._obs: list[Any] = [None for _ in envs]

    def reset(self, seed: Any = None, options: Any = None) -> tuple[np.ndarray, dict]:
        """Observations [N, o]; options: `reset_mask` [N] bool, which begin a new episode."""
        which = options["reset_mask"] if options else np.ones(len(self.envs), bool)
        for i in np.flatnonzero(which):
            self._obs[i] = self.envs[i].reset(seed=seed[i] if seed else None)[0]
        return np.array(self._obs, np.float32), {}

    def step(self, actions: np.ndarray) -> tuple:
        """Observations [N, o], rewards [N], terminated, truncated [N]; of infos FLAGS alone."""
        infos: dict[str, np.ndarray] = {}
        rewards = np.empty(len(actions), np.float32)
        ended, cut = np.empty(len(actions), bool), np.empty(len(actions), bool)
        for i, env in enumerate(self.envs):
            self._obs[i], rewards[i], ended[i], cut[i], info = env.step(actions[i])
            for name in (name for name in FLAGS if name in (info or ())):
                infos.setdefault(name, np.zeros(len(actions), bool))[i] = np.any(info[name])
        return np.array(self._obs, np.float32), rewards, ended, cut, infos

    def render(self) -> list[Any]:
        """A picture of each."""
        return [env.render() for env in self.envs]

    def close(self) -> None:
        """End them."""
        for env in self.envs:
            env.close()


class Repeated(gymnasium.Wrapper):
    """Takes each action for several steps, or until its episode ends; their rewards are added."""

    def __init__(self, make: Callable[[], gymnasium.Env], repeat: int) -> None:
        super().__init__(make())
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


class Located(gymnasium.Wrapper):
    """In a process: an error has the user's line in its message, as the traceback stays there."""

    def __init__(self, make: Callable[[], gymnasium.Env]) -> None:
        super().__init__(self._located(make))

    def reset(self, **options: Any) -> Any:
        """The environment's reset."""
        return self._located(lambda: self.env.reset(**options))

    def step(self, action: Any) -> Any:
        """The environment's step."""
        return self._located(lambda: self.env.step(action))

    @staticmethod
    def _located(call: Callable[[], Any]) -> Any:
        try:
            return call()
        except FAULTS as error:
            raise RuntimeError(blame(error)) from error
