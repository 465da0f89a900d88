"""The process that owns a robot: it decides at a fixed rate and never waits for its learner.

    observe -> decide with the newest parameters -> limit -> hold -> apply -> append a row -> sleep

What predicts holds an action back until it acts whole decisions after its observation.

Files in a folder connect it with the learner: `rows` (row_log) in one direction, `parameters`
(handover) in the other, and `stop`, whose existence ends the motion. So either process can be
killed and started again while the other one goes on.

Times are those of one monotonic clock. Decision k begins at t0 + k dt; after a missed deadline the
periods that are over are left out. A decision without an outcome is not recorded, and what follows
is another stretch.
"""

import gc
import math
import os
import reprlib
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.envs.adapters.robot import PENDING, Robot
from hybrid_rl.errors import FAULTS, WorldError, blame, one_line
from hybrid_rl.outside import handover
from hybrid_rl.outside.acting import Exploring
from hybrid_rl.outside.lag import known_lag
from hybrid_rl.outside.robot_process import WAITING, report
from hybrid_rl.outside.row_log import RowLog, row_type
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.wrappers import whole
from hybrid_rl.types import Params

RESET_S = 120.0  # [s] that a robot's `reset` may take
LATEST = 0.9  # of a period, in which an action is sent
NEW = 0.01  # weight of the newest age in the mean age of observations
RETRY_S = 1.0  # [s] between attempts to reach a robot that does not answer
LOST = 3  # exit code: the robot does not answer
OBSERVED = "must return (observation [{}], its time.monotonic()); it returned {}"


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
        self.env, self.spec, self._kind = env, env.spec, row_type(env.spec)
        self._decide = Exploring(self.agent, self.seed)
        if self.params is not None:
            self._decide.take(self.params)
        self._lag = known_lag(self.env, self.folder) or 0.0
        self._why = ""  # there are no observations
        self._age = 0.0  # [s] of observations that a decision begins with, the mean of late
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
        self._number = self._stretch = self._episode = 0
        if last is not None:
            self._number = int(last["number"]) + 1
            self._stretch, self._episode = int(last["stretch"]), int(last["episode"])
        for thread in (self._watch, self._receive):
            threading.Thread(target=thread, daemon=True).start()
        end = time.monotonic() + seconds
        gc.freeze()
        gc.disable()
        try:
            while not self._over() and self._decide.params is None:
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
        row, before, taken, self._return = None, 0.0, 0, 0.0  # of the decision before
        began, k, heard = time.monotonic(), 0, time.monotonic()
        self._past = [(-math.inf, self.env.safe)] * (PENDING + 1)
        while not self._over() and (begin := began + k * self.spec.dt) < end:
            _sleep_until(begin)
            obs, stamp = self._observed()
            if obs is not None:
                heard, taken = time.monotonic(), taken + (row is not None)
                if row is not None:
                    row["interval"] = stamp - before
                    if self._record(row, obs, taken):
                        return None
            elif time.monotonic() - heard > self.env.silence_s:
                return self._silent(f"no observation for {self.env.silence_s:g} s{self._why}")
            row = None if obs is None else self._acted(obs, stamp, begin)
            before = stamp
            if row is None:
                self.counts.unsafe += 1
                self._apply(self.env.safe)
            if (late := time.monotonic() - begin) > self.spec.dt:
                row, self.counts.missed = None, self.counts.missed + 1
            self._stretch += row is None
            k += max(1, math.ceil(late / self.spec.dt))
        return None

    def _acted(self, obs: np.ndarray, stamp: float, begin: float) -> np.ndarray | None:
        """The row of a decision at `obs` that was applied; None if it is not finite.

        stamp: of the observation; begin: of the period.
        """
        age, dt = time.monotonic() - stamp, self.spec.dt
        self._age += (age - self._age) * (NEW if self._age else 1.0)
        lag = min(whole((self._age + self._lag) / dt), PENDING)  # [decisions]
        self._decide.informed(np.array([u for _, u in self._past[::-1]]), lag)
        u, rate, last = self._decide(obs, self._number), self.env.rate or 2.0, self._past[0][1]
        action = np.clip(np.clip(u, last - rate, last + rate), -1, 1)
        if not np.isfinite(action).all():
            return None
        if self._decide.predicts:
            _sleep_until(min(stamp + lag * dt - self._lag, begin + LATEST * dt))
        self._apply(action)
        now, row = self._past[0][0], np.zeros((), self._kind)
        row["obs"], row["action"], row["version"] = obs, action, self._version
        row["late"], row["age"], row["time"] = now - begin, now - stamp, time.time()
        row["times"], row["sent"] = zip(*((at - stamp, u) for at, u in self._past), strict=True)
        return row

    def _record(self, row: np.ndarray, obs: np.ndarray, taken: int) -> bool:
        """Append the row of the decision that led to `obs`; whether it ended the episode."""
        seen, physical = row["obs"], self._physical(row["action"])
        reward = self._call("reward", lambda: float(self.robot.reward(seen, physical, obs)))
        if not math.isfinite(reward):
            raise WorldError(f"{self.env.name}: reward: gives {reward}")
        failed = getattr(self.robot, "terminated", lambda obs: False)
        terminated = self._call("terminated", lambda: bool(failed(obs)))
        truncated = not terminated and taken >= self.agent.episode.steps
        row["number"], row["stretch"] = self._number, self._stretch
        row["episode"], row["next_obs"], row["reward"] = self._episode, obs, reward
        row["terminated"], row["truncated"] = terminated, truncated
        row["missed"], row["unsafe"] = self.counts.missed, self.counts.unsafe
        if self.log is not None:
            self.log.append(row)
        self.counts.decisions += 1
        self._number, self._return = self._number + 1, self._return + reward
        if terminated or truncated:
            self.counts.returns.append(self._return)
        return terminated or truncated

    def _observed(self) -> tuple[np.ndarray | None, float]:
        """(observation [o], its time); None if there is none to act on."""
        size, most, age = self.env.kind.obs, self.env.stale * self.spec.dt, math.nan
        with suppress(OSError):  # a robot that does not answer
            given = self._call("observe", self.robot.observe)
            try:
                obs, stamp = np.array(given[0], np.float32), float(given[1])
                age = time.monotonic() - stamp
                wrong = obs.shape != (size,) or age < -most
            except (TypeError, ValueError, LookupError):
                wrong = True
            if wrong:
                line = OBSERVED.format(size, reprlib.repr(given))
                raise WorldError(f"{self.env.name}: observe: {line}")
            beyond = age - (self._age or min(age, self.env.silence_s))
            if beyond <= most and np.isfinite(obs).all():  # a time that is NaN is no time
                return obs, stamp
            words = f"{1e3 * age:.0f} ms old, {1e3 * beyond:.0f} more than usual"
            self._why = f"; the newest was {words}, and env.stale allows {1e3 * most:.0f}"
        self.counts.stale += 1
        return None, 0.0

    def _apply(self, action: np.ndarray) -> None:
        with suppress(OSError):  # a lost connection: there will be no observation, either
            self._call("apply", lambda: self.robot.apply(self._physical(action)))
        self._past = [(time.monotonic(), action), *self._past[:-1]]

    def _silent(self, why: str) -> None:
        """End motion, and wait for `alone_s` until the robot answers; the learner shows why."""
        self.robot.stop()
        line = f"{self.env.name}: {why}"
        report(self.folder, line + WAITING)
        self._since, self._age = min(self._since, time.monotonic()), 0.0
        while not self._over():
            if time.monotonic() - self._since > self.env.alone_s:
                raise TimeoutError(f"{line}, nothing else for {self.env.alone_s:g} s")
            if self._observed()[0] is not None:
                break
            self._beat = time.monotonic()
            time.sleep(RETRY_S)
        (self.folder / "error").unlink(missing_ok=True)

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
                known, self._version = now, found[0]
                self._decide.take(found[1])
                self._lag = known_lag(self.env, self.folder) or 0.0
            time.sleep(self.env.handover_s / 2)


def _sleep_until(moment: float) -> None:
    """Sleep until a time of the monotonic clock; the last half millisecond is spent awake."""
    while (left := moment - time.monotonic()) > 0:
        time.sleep(max(left - 5e-4, 0))
