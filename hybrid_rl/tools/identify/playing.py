"""A plan played on a robot, and the log of it.

The robot is a class as `task=robot` has it (docs/howto_deploy.md): `dt`, `observe`, `apply`, `stop`
and `reset`. Its actions are the commands of the model's actuators, and its observations begin with
the positions of the model's joints. `reset` must leave it at rest where the plan begins. Whatever
goes wrong ends in `stop`: no observation for SILENCE, one that is not finite, a position beyond its
limits, an exception, Ctrl-C.

It runs in this process: nothing ends the motion if `observe` or `apply` never returns. It does not
look at speeds, which only the plan keeps.
"""

import time
from typing import Any

import numpy as np

from hybrid_rl import UsageError
from hybrid_rl.tools.identify.excitation import Plan
from hybrid_rl.tools.identify.log import Log
from hybrid_rl.tools.identify.system import System

SILENCE = 0.2  # [s] without a new observation
REST = 0.5  # [s] at the first command, before the log begins


def play(system: System, plan: Plan | Log, robot: Any) -> Log:
    """Play a plan, and log the newest position at each command.

    Raises:
        UsageError: if the robot was stopped; the line says why.
    """
    n, rows = system.base.nq, []
    try:
        robot.reset()
        begun = time.monotonic() + REST
        for t, ctrl in zip((-REST, *plan.t), (plan.ctrl[0], *plan.ctrl), strict=True):
            while (left := begun + t - time.monotonic()) > 0:
                time.sleep(left)
            obs, stamp = robot.observe()
            _check(system, np.asarray(obs, float)[:n], time.monotonic() - stamp, rows)
            sent = time.monotonic()
            robot.apply(ctrl)
            rows.append((stamp, sent, *ctrl, *np.asarray(obs, float)[:n]))
    finally:
        robot.stop()
    table = np.array(rows[1:])
    new = np.append(True, np.diff(table[:, 0]) > 0)  # an observation that came twice counts once
    t, m = table[:, 0] - begun, system.base.nu
    sent = table[:, 1] - begun
    q = np.stack([np.interp(sent, t[new], column) for column in table[new, 2 + m :].T], axis=1)
    return Log(sent, table[:, 2 : 2 + m], q)


def _check(system: System, q: np.ndarray, age: float, rows: list) -> None:
    """Raise UsageError for an observation at which the motion ends."""
    if age > SILENCE:
        raise UsageError(f"the newest observation is {age:.2f} s old; the robot was stopped")
    if not np.isfinite(q).all():
        raise UsageError("an observation is not finite; the robot was stopped")
    if system.base.nq == system.base.nv and ((q < system.bounds[0]) | (q > system.bounds[1])).any():
        raise UsageError(f"a position is beyond its limits, {q.tolist()}; the robot was stopped")
