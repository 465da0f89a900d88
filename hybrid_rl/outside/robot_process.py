"""The learner's view of the process that owns the robot: it starts it, watches it, and stops it."""

import fcntl
import os
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.errors import UsageError, WorldError
from hybrid_rl.files.atomic import open_own

TRIES = 5  # starts of the process in a row without a new decision
LOWER = 10  # priority of the learner
WAITING = "; waiting for it"  # ends a line about a robot that may go on


class RobotProcess:
    """The robot's process, started at the first `watch`, and again if it dies."""

    def __init__(self, env: Robot, folder: Path) -> None:
        """folder: of the files that it shares."""
        self.env, self.folder = env, folder
        self.child: subprocess.Popen | None = None
        self.tries, self.ended, self.checked, self.shown = 0, False, 0.0, ""

    def alive(self) -> bool:
        """Whether a process owns the robot: a child of this one, or of a learner before it."""
        if self.child is not None and self.child.poll() is None:
            return True
        with open_own(self.folder / "lock") as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                return True
        return False

    def watch(self) -> None:
        """Start the process if there is none; show why a robot is waited for."""
        if time.monotonic() - self.checked < 0.2:
            return
        self.checked = time.monotonic()
        alive, line, error = self.alive(), "", self.folder / "error"
        with suppress(FileNotFoundError), open_own(error, "r") as file:
            line = file.read(10_000)
        if alive:  # else the line is that of its end, which may come a moment later
            return self._show(line) if line.endswith(WAITING) or not line else None
        code = None if self.child is None else self.child.returncode
        if code == 0:
            self.ended = True
        elif code == 2 or self.tries >= TRIES:
            raise WorldError(line or f"{self.env.name}: its process ended with {code}")
        else:
            self._show(line)
            error.unlink(missing_ok=True)
            self._start()

    def _show(self, line: str) -> None:
        """Print what the robot's process says, once."""
        if line and line != self.shown:
            print(f"hybrid_rl: {line}", file=sys.stderr, flush=True)
        self.shown = line

    def _start(self) -> None:
        self.tries += 1
        run = self.folder.parent.resolve()
        _lower()
        flags = f"{os.environ.get('XLA_FLAGS', '')} --xla_cpu_multi_thread_eigen=false"
        with open_own(self.folder / "console") as out:
            self.child = subprocess.Popen(
                [sys.executable, "-m", "hybrid_rl.robot", f"run={run}", "learning=true"],
                env=os.environ | {"JAX_PLATFORMS": "cpu", "XLA_FLAGS": flags},
                stdout=out,
                stderr=out,
            )

    def stop(self) -> None:
        """End motion, then the process."""
        if not self.alive():
            return
        open_own(self.folder / "stop").close()
        until = time.monotonic() + 10
        while self.alive() and time.monotonic() < until:
            time.sleep(0.01)
        if self.child is not None and self.child.poll() is None:
            self.child.kill()


def report(folder: Path, line: str) -> None:
    """Leave a line for the learner, which shows it; to end motion does not depend on it."""
    with suppress(OSError, UsageError), open_own(folder / "error", "w") as file:
        file.write(line)


def _lower() -> None:
    """Lower the priority of this process' threads, those of XLA too, below the robot's."""
    for thread in Path("/proc/self/task").glob("*"):
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, int(thread.name), LOWER)
