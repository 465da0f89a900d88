"""Copies of a Gymnasium environment that step side by side, and what a decision led to."""

import multiprocessing
from collections.abc import Callable, Sequence
from functools import cached_property, partial
from typing import Any, NamedTuple

import gymnasium
import numpy as np
from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv
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
        self._apart = env.processes or env.timeout_s is not None

    @cached_property
    def _vector(self) -> Any:
        one = partial(self.env.one, self.render_mode)
        one = one if self.repeat == 1 else partial(Repeated, one, self.repeat)
        makers = [one for _ in self.seeds]
        if self._apart:
            return AsyncVectorEnv(makers, context="spawn", autoreset_mode=AutoresetMode.DISABLED)
        return SyncVectorEnv(makers, copy=False, autoreset_mode=AutoresetMode.DISABLED)

    def reset(self) -> np.ndarray:
        """The first observations [N, o]; the first call seeds the environments."""
        self.decisions[:] = 0
        obs = self._observed("reset", lambda: self._vector.reset(seed=self.seeds))[0]
        self.seeds = [None for _ in self.seeds]  # a seed at each reset would repeat one start
        return obs

    def step(self, u: np.ndarray) -> Outcome:
        """Actions u [N, m] in [-1, 1]; where an episode ends, another one begins.

        Raises:
            WorldError: if the environment raises an error, gives NaN, or takes too long.
        """
        low, high = self.env.bounds
        share = (np.clip(np.asarray(u, np.float32), -1, 1) + 1) / 2
        space = self.env.known.space
        actions = (low + share * (high - low)).reshape(-1, *space.shape)
        actions = (np.rint(actions) if space.dtype.kind in "iu" else actions).astype(space.dtype)
        obs, paid, ended, cut, infos = self._observed("step", lambda: self._stepped(actions))
        if not np.isfinite(paid).all():
            raise WorldError(f"{self.env.name}: step: gives a reward that is not finite")
        self.decisions += 1
        given = [np.asarray(infos[name]) for name in FLAGS if name in infos]
        self.success = given[0].astype(bool).reshape(len(paid), -1).any(1) if given else None
        cut, following = (cut | (self.decisions >= self.steps)) & ~ended, obs
        if (done := ended | cut).any():
            self.decisions[done] = 0
            options = {"reset_mask": done}
            fresh = self._observed("reset", lambda: self._vector.reset(options=options))[0]
            following = np.where(done[:, None], fresh, obs)
        return Outcome(obs, np.asarray(paid, np.float32), ended, cut, following)

    def picture(self) -> np.ndarray:
        """The first environment [height, width, 3] (uint8), with render_mode="rgb_array"."""
        found = self._call("render", lambda: self._vector.render()[0])
        if not (isinstance(found, np.ndarray) and found.ndim == 3):
            line = f"{self.env.name}: render: returns {type(found).__name__}"
            raise WorldError(f"{line}; {PICTURE}")
        return found[: found.shape[0] // 2 * 2, : found.shape[1] // 2 * 2]

    def _stepped(self, actions: np.ndarray) -> tuple:
        """What the vector's `step` returns, within the limit of time."""
        if not self._apart:
            return self._vector.step(actions)
        self._vector.step_async(actions)
        limit = self.env.timeout_s
        return self._vector.step_wait(None if limit is None else limit * self.repeat)

    def _call(self, method: str, call: Callable[[], Any]) -> Any:
        """The result of a method of the environments; an error is one line."""
        before = gymnasium.logger.min_level
        if self._apart:  # Gymnasium's log has the traceback of what it raises again
            gymnasium.logger.min_level = SILENT
        try:
            return call()
        except UsageError:
            raise
        except multiprocessing.TimeoutError as error:
            self._kill()
            line = f"{self.env.name}: {method}: took longer than env.timeout_s"
            raise WorldError(f"{line}={self.env.timeout_s}") from error
        except FAULTS as error:
            line = blame(error)
            if self._apart and isinstance(error, EOFError | ConnectionError):
                self._kill()
                line = "its process ended, as where there is no memory left"
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

    def _observed(self, method: str, call: Callable[[], Any]) -> list[Any]:
        """What `call` of a method returns, with a copy of the observations as float32 [N, o]."""
        obs, *rest = self._call(method, call)
        obs = np.array(obs, np.float32)  # the environment may overwrite its own
        if not np.isfinite(obs).all():
            entry = int(np.argwhere(~np.isfinite(obs))[0, 1])
            raise WorldError(f"{self.env.name}: {method}: entry {entry} of obs is not finite")
        return [obs, *rest]

    def close(self) -> None:
        """End the environments, and their processes."""
        if "_vector" in vars(self):
            vars(self).pop("_vector").close()


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
