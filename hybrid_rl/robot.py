"""A trained run on its robot, at the robot's rate, until Ctrl-C.

    python -m hybrid_rl.robot run=runs/robot/sac/TIME
    python -m hybrid_rl.robot run=runs/robot/sac/TIME mode=policy seconds=60

The run was trained by `python -m hybrid_rl.train task=robot env.make=MODULE:CLASS`, which starts
this command with learning=true for the process that owns the robot. Ctrl-C ends motion first.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import math
import os
import signal
import sys
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import jax

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import MODE, Argument, flag, number, read
from hybrid_rl.envs.adapters.robot import PENDING
from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import refuse_link
from hybrid_rl.files.lock import lock
from hybrid_rl.outside.actor import LOST, Actor
from hybrid_rl.outside.robot_process import report
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.run.saved import build_run, load
from hybrid_rl.training.ahead import ahead

HIGHER = 10  # priority of the robot's process, where the system allows it
ARGUMENTS = (
    Argument("run", "", "folder of the run", needed="run=DIR, of a run of task=robot"),
    Argument("mode", "full", "full: planner and policy; policy or planner: one alone", MODE),
    Argument("seconds", math.inf, "of motion", number(0.0)),
    Argument("learning", False, "true: rows for a learner", flag),
)


def _trained(folder: Path, mode: str) -> Actor:
    """The newest checkpoint, without exploration and without rows."""
    trained = load(folder)
    controller, params = trained.learner(None, mode)
    assert trained.agent is not None
    acting = ahead(controller, trained.agent.spec, 0.0, PENDING)
    agent = replace(trained.agent, controller=acting, random_steps=0)
    return Actor(agent, folder / "robot", trained.seeds[0], False, jax.device_put(params))


def _learning(folder: Path) -> Actor:
    """With exploration, for a learner that reads the rows."""
    config = run_folder.read(folder, "run")
    prepare(config)
    run = build_run(config)
    return Actor(run.agent, folder / "robot", run.seeds[0], most=config.total_steps)


def _hurry() -> None:
    """Run ahead of all other processes, or of those with the usual priority, if the system lets."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
    except OSError:
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, 0, -HIGHER)


def main() -> None:
    """The command."""
    given = read(__doc__, ARGUMENTS)[0]
    _hurry()  # before XLA makes its threads, which have the same priority
    folder = Path(given["run"])
    files = refuse_link(folder / "robot")
    if not files.is_dir():
        raise UsageError(f"run={folder}: holds no run of task=robot")
    with lock(files, "run"):
        (files / "stop").unlink(missing_ok=True)
        actor = _learning(folder) if given["learning"] else _trained(folder, given["mode"])
        _move(actor, given["seconds"])


def _move(actor: Actor, seconds: float) -> None:
    """Run the actor, and say what became of it."""

    def ask(number: int, frame: Any) -> None:
        actor.asked = True

    for name in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(name, ask)
    try:
        actor.run(seconds)
    except UsageError as error:
        report(actor.folder, str(error))
        raise
    except TimeoutError as error:
        report(actor.folder, str(error))
        print(f"hybrid_rl: {error}", file=sys.stderr)
        sys.exit(LOST)
    counts = actor.counts
    if returns := counts.returns:
        mean = sum(returns) / len(returns)
        print(f"{len(returns)} episodes, mean return {mean:,.1f}")
    print(
        f"{counts.decisions:,} decisions, {counts.missed} deadlines missed, {counts.unsafe} safe "
        f"actions, {counts.stale} observations missing or too old",
        flush=True,
    )


if __name__ == "__main__":
    command.run(main)
