"""A plan played on a robot, and the log of it.

The robot is a class as `task=robot` has it (docs/howto_deploy.md). Its actions are the commands of
the model's actuators, and its observations begin with the positions of the model's joints. `reset`
must leave it at rest where the plan begins.

As in a run, it is stopped when an observation is too old, when `observe` or `apply` does not
return, at an exception and by Ctrl-C; here also if a position is not finite or beyond its limits.
Nothing looks at speeds, which only the plan keeps.
"""

import threading
import time
from typing import Any

import numpy as np

from hybrid_rl import UsageError
from hybrid_rl.tools.identify.excitation import DT, Plan
from hybrid_rl.tools.identify.log import Log
from hybrid_rl.tools.identify.system import System

SILENCE = 0.2  # [s] without a new observation, or in a method
REST = 0.5  # [s] at the first command, before the log begins
STOPPED = "the robot was stopped"


def play(system: System, plan: Plan | Log, robot: Any) -> Log:
    """Play a plan, and log the newest position at each command.

    Raises:
        UsageError: if the robot was stopped; the line says why.
    """
    player = _Player(system, plan, robot)
    try:
        robot.reset()
        player.start()
        while player.is_alive() and time.monotonic() < player.due:
            player.join(0.02)
    finally:
        player.stopped = True
        robot.stop()
    if player.is_alive():
        player.error = UsageError(f"observe or apply did not return in {SILENCE} s; {STOPPED}")
    if player.error:
        raise player.error
    return player.log()


class _Player(threading.Thread):
    """The motion, in a thread of its own, so that another can end it."""

    def __init__(self, system: System, plan: Plan | Log, robot: Any) -> None:
        super().__init__(daemon=True)
        self.system, self.plan, self.robot = system, plan, robot
        self.due, self.stopped = np.inf, False  # due: when the next command is late
        self.rows: list[tuple] = []
        self.error: Exception | None = None

    def run(self) -> None:
        """Send each command at its time."""
        self.begun, plan = time.monotonic() + REST, self.plan
        waiting = -np.arange(DT, REST, DT)[::-1]
        first = np.repeat(plan.ctrl[:1], len(waiting), axis=0)
        try:
            for t, u in zip((*waiting, *plan.t), (*first, *plan.ctrl), strict=True):
                self.due = self.begun + t + SILENCE
                while not self.stopped and (left := self.begun + t - time.monotonic()) > 0:
                    time.sleep(left)
                obs, stamp = self.robot.observe()
                q = np.asarray(obs, float)[: self.system.base.nq]
                self._check(q, time.monotonic() - stamp)
                if self.stopped:
                    return
                sent = time.monotonic()
                self.robot.apply(u)
                self.rows.append((stamp, sent, *u, *q))
        except Exception as error:
            self.error = error

    def _check(self, q: np.ndarray, age: float) -> None:
        """Raise UsageError for an observation at which the motion ends."""
        system, line = self.system, ""
        if age > SILENCE:
            line = f"the newest observation is {age:.2f} s old"
        elif not np.isfinite(q).all():
            line = "an observation is not finite"
        elif (
            system.base.nq == system.base.nv
            and ((q < system.bounds[0]) | (q > system.bounds[1])).any()
        ):
            line = f"a position is beyond its limits, {q.tolist()}"
        if line:
            raise UsageError(f"{line}; {STOPPED}")

    def log(self) -> Log:
        """The log of what was sent and observed."""
        table, m = np.array(self.rows[-len(self.plan.t) :]), self.system.base.nu
        stamp, sent = table[:, 0] - self.begun, table[:, 1] - self.begun
        new = np.append(True, np.diff(stamp) > 0)  # what came twice counts once
        seen = sent <= stamp[-1]  # there is no position at later commands
        columns = table[new, 2 + m :].T
        q = np.stack([np.interp(sent[seen], stamp[new], column) for column in columns], axis=1)
        return Log(sent[seen], table[seen, 2 : 2 + m], q)
