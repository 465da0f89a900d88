"""The process that owns a robot: it decides at a fixed rate and never waits for its learner.

    observe -> decide with the newest parameters -> limit -> apply -> append a row -> sleep

Files in a folder connect it with the learner: `rows` (data.row_log) in one direction, `parameters`
(data.handover) in the other, and `stop`, whose existence ends the motion. So either process can be
killed and started again while the other one goes on.

Times are those of one monotonic clock. Decision k begins at t0 + k dt; after a missed deadline the
periods that are over are left out, and the rows before and after belong to two stretches.
"""

import gc
import math
import os
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import jax
import numpy as np

from hybrid_rl.data import handover
from hybrid_rl.data.row_log import RowLog
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.errors import FAULTS, UsageError, WorldError, blame, one_line
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.decider import Decider
from hybrid_rl.training.robot_process import WAITING, report
from hybrid_rl.types import Params

RESET_S = 120.0  # [s] that a robot's `reset` may take
RETRY_S = 1.0  # [s] between attempts to reach a robot that does not answer
LOST = 3  # exit code: the robot does not answer


@dataclass
class Counts:
    """What happened since the process began."""

    decisions: int = 0
    missed: int = 0  # deadlines
    unsafe: int = 0  # safe actions in place of others
    stale: int = 0  # observations that were too old, missing or not finite
    returns: list[float] = field(default_factory=list)  # of whole episodes


@dataclass
class Actor:
    """One robot, with the controller of `agent`; its files are in `folder`.

    recording: whether decisions are appended to `rows`, and a learner is expected. most: decisions
    in `rows`, after which motion ends.
    """

    agent: Agent
    folder: Path
    seed: int = 0
    recording: bool = True
    params: Params | None = None  # None: the first that a learner writes
    most: float = math.inf
    counts: Counts = field(default_factory=Counts)
    asked: bool = False  # by a signal

    def __post_init__(self) -> None:
        """Compile; the robot is made by `run`."""
        env = self.agent.episode.env
        assert isinstance(env, Robot)
        self.env, self.spec = env, env.spec
        self._decide = Decider(self.agent, self.seed, self.recording)
        self._version, self._beat, self._allowed = 0, time.monotonic(), math.inf
        self._made, self._ended = time.time(), False
        self._since = math.inf  # when the robot fell silent, if it has begun no episode since

    def run(self, seconds: float = math.inf) -> None:
        """Move until asked to stop, or for so many seconds.

        Raises:
            WorldError: if a method of the robot's is wrong; motion has ended then.
            TimeoutError: likewise, without a sign of the learner for `alone_s`.
        """
        self.robot = self.env.made()
        self.log = RowLog(self.folder / "rows", self.spec) if self.recording else None
        last = self.log.recover() if self.log else None
        self._number = int(last["number"]) + 1 if last is not None else 0
        self._stretch = int(last["stretch"]) + 1 if last is not None else 0
        self._episode = int(last["episode"]) if last is not None else 0
        for thread in (self._watch, self._receive):
            threading.Thread(target=thread, daemon=True).start()
        end = time.monotonic() + seconds
        gc.freeze()
        gc.disable()
        try:
            while not self._over() and self.params is None:
                time.sleep(0.01)
            while not self._over() and time.monotonic() < end:
                self._drive(end)
        finally:
            self._ended, self._allowed = True, math.inf
            gc.enable()
            self.robot.stop()

    def _over(self) -> bool:
        """Whether to stop: after a signal, for the file `stop`, or with enough rows."""
        if self.asked or (self.folder / "stop").exists() or self._number >= self.most:
            return True
        file, alone_s = self.folder / "parameters", self.env.alone_s
        seen = max(file.stat().st_mtime if file.exists() else 0.0, self._made)
        if self.recording and time.time() - seen > alone_s:
            raise TimeoutError(f"{self.env.name}: no sign of its learner for {alone_s:g} s")
        return False

    def _drive(self, end: float) -> None:
        """An episode, or what there is of it until the robot falls silent."""
        try:
            self._call("reset", self.robot.reset, RESET_S)
        except OSError as error:
            time.sleep(RETRY_S)
            return self._silent(f"reset: {one_line(error)}")
        self._since = math.inf
        self._episode, self._stretch = self._episode + 1, self._stretch + 1
        self._decide.begin()
        pending, taken, self._return = None, 0, 0.0
        began, k, heard = time.monotonic(), 0, time.monotonic()
        past = [self.env.safe] * max(self.env.past_actions, 1)  # the newest first
        while not self._over() and (begin := began + k * self.spec.dt) < end:
            _sleep_until(begin)
            obs, stamp = self._observed(past)
            if obs is None:
                if time.monotonic() - heard > self.env.silence_s:
                    return self._silent(f"no observation for {self.env.silence_s:g} s")
                past, pending = [self._safe(), *past[:-1]], self._left_out(pending)
                k += 1
                continue
            heard = time.monotonic()
            if pending is not None:
                taken += 1
                if self._record(pending, obs, taken):
                    return None
            action = self._limited(self._decide(self.params, obs, self._number), past[0])
            if not np.isfinite(action).all():
                past, pending = [self._safe(), *past[:-1]], self._left_out(pending)
                k += 1
                continue
            self._apply(action)
            now, past = time.monotonic(), [action, *past[:-1]]
            pending = obs, action, now - begin, now - stamp, self._version
            k += 1
            if now - begin > self.spec.dt:
                self.counts.missed += 1
                pending, k = self._left_out(pending), math.ceil((now - began) / self.spec.dt)
        return None

    def _record(self, pending: tuple, obs: np.ndarray, taken: int) -> bool:
        """Append the decision before `obs`; whether it ended the episode."""
        before, action, late, age, version = pending
        self.counts.decisions += 1
        physical = self._physical(action)
        size = self.env.kind.obs
        seen, after = before[:size], obs[:size]
        reward = self._call("reward", lambda: float(self.robot.reward(seen, physical, after)))
        if not math.isfinite(reward):
            raise WorldError(f"{self.env.name}: reward: gives {reward}")
        failed = getattr(self.robot, "terminated", lambda obs: False)
        terminated = self._call("terminated", lambda: bool(failed(after)))
        truncated = not terminated and taken >= self.agent.episode.steps
        if self.log is not None:
            values = (self._number, self._stretch, self._episode, time.time(), before, action)
            values += (reward, terminated, truncated, obs, late, age, version)
            row = np.array((*values, self.counts.missed, self.counts.unsafe, 0), self.log.kind)
            self.log.append(row)
        self._number, self._return = self._number + 1, self._return + reward
        if terminated or truncated:
            self.counts.returns.append(self._return)
        return terminated or truncated

    def _observed(self, past: list[np.ndarray]) -> tuple[np.ndarray | None, float]:
        """(observation [o] with past actions, its time); None if there is none to act on."""
        try:
            given = self._call("observe", self.robot.observe)
        except OSError:  # a robot that does not answer
            self.counts.stale += 1
            return None, 0.0
        try:
            seen, stamp = given
            obs, stamp = np.array(seen, np.float32), float(stamp)
        except (TypeError, ValueError) as error:
            line = "must return (observation, its time.monotonic()), all numbers"
            raise WorldError(f"{self.env.name}: observe: {line}") from error
        if obs.shape != (self.env.kind.obs,):
            line = f"gives {list(obs.shape)}, and the class says obs = {self.env.kind.obs}"
            raise WorldError(f"{self.env.name}: observe: {line}")
        age, most = time.monotonic() - stamp, self.env.stale * self.spec.dt
        if age < -most:
            line = f"its time is {-age:.3g} s ahead of time.monotonic(), whose it must be"
            raise WorldError(f"{self.env.name}: observe: {line}")
        if not (age <= most and np.isfinite(obs).all()):  # a time that is NaN is no time
            self.counts.stale += 1
            return None, 0.0
        return np.concatenate([obs, *past[: self.env.past_actions]]), stamp

    def _apply(self, action: np.ndarray) -> None:
        with suppress(OSError):  # a lost connection: there will be no observation, either
            self._call("apply", lambda: self.robot.apply(self._physical(action)))

    def _safe(self) -> np.ndarray:
        """Apply the safe action, and return it."""
        self.counts.unsafe += 1
        self._apply(self.env.safe)
        return self.env.safe

    def _silent(self, why: str) -> None:
        """End motion, and wait until the robot answers again; the learner shows why.

        Raises:
            TimeoutError: if it has begun no episode for `alone_s`.
        """
        self.robot.stop()
        line = f"{self.env.name}: {why}"
        report(self.folder, line + WAITING)
        self._since = min(self._since, time.monotonic())
        while not self._over():
            if time.monotonic() - self._since > self.env.alone_s:
                raise TimeoutError(f"{line}, nothing else for {self.env.alone_s:g} s")
            if self._observed([])[0] is not None:
                break
            self._beat = time.monotonic()
            time.sleep(RETRY_S)
        (self.folder / "error").unlink(missing_ok=True)

    def _left_out(self, pending: tuple | None) -> None:
        """None, in place of a decision without an outcome; a new stretch begins after it."""
        self._stretch += pending is not None

    def _limited(self, u: np.ndarray, previous: np.ndarray) -> np.ndarray:
        """The action within the bounds, and within `rate` of the one before."""
        if self.env.rate is not None:
            u = np.clip(u, previous - self.env.rate, previous + self.env.rate)
        return np.clip(u, -1, 1).astype(np.float32)

    def _physical(self, action: np.ndarray) -> np.ndarray:
        low, high = self.env.bounds
        return low + (action + 1) / 2 * (high - low)

    def _call(self, method: str, call: Callable[[], Any], most: float = 0.0) -> Any:
        """The result of a method of the robot's, which has `silence_s` or `most` [s] to return."""
        self._beat, self._allowed = time.monotonic(), most or self.env.silence_s
        self._in = method
        try:
            return call()
        except (OSError, WorldError):  # of a connection; TimeoutError is one
            raise
        except FAULTS as error:
            line = blame(error)
            raise WorldError(f"{self.env.name}: {method}: {line}") from error
        finally:
            self._allowed = math.inf

    def _watch(self) -> None:
        """End motion and the process if a method of the robot's does not return."""
        while not self._ended:
            time.sleep(0.05)
            if time.monotonic() - self._beat > self._allowed:
                line = f"{self.env.name}: {self._in}: did not return in {self._allowed:g} s"
                report(self.folder, line)
                try:
                    self.robot.stop()
                finally:
                    os._exit(LOST)

    def _receive(self) -> None:
        """Replace the parameters whenever there are newer ones."""
        file, known = self.folder / "parameters", None
        while self.recording and not self._ended:
            try:
                now = file.stat().st_mtime_ns
            except OSError:
                now = None
            if now != known and (found := handover.latest(file, self._decide.like)) is not None:
                known = now
                self._version, self.params = found[0], jax.device_put(found[1])
            time.sleep(self.env.handover_s / 2)


def _sleep_until(moment: float) -> None:
    """Sleep until a time of the monotonic clock; the last half millisecond is spent awake."""
    while (left := moment - time.monotonic()) > 0:
        time.sleep(max(left - 5e-4, 0))


def check_one(agent: Agent, seeds: tuple[int, ...]) -> None:
    """Raise UsageError unless there is one learner, with one environment."""
    if len(seeds) > 1 or agent.num_envs > 1:
        raise UsageError(
            f"num_seeds={len(seeds)}, num_envs={agent.num_envs}: one robot has one learner; "
            "give 1 and 1"
        )
