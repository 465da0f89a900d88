"""Faults in the processes, files and datagrams of a robot that learns, and what they cost.

    python -m scripts.robot_faults faults=40 faulty=0.2 out=FILE.json

A stand-in robot loses, delays, doubles and cuts a share of its datagrams, while processes are
killed or stopped at random and files are damaged. At the end it is checked that

* the robot took decisions again after each fault (no hang), and each action was within its bounds;
* the rows are numbered without a gap, and sound;
* the replay memory of the last checkpoint holds them as they are in the file, by what acted.
"""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import numpy as np

from hybrid_rl.cli.arguments import Argument, number, read, whole
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.envs.adapters.stand_in import Cartpole
from hybrid_rl.outside.lag import known_lag
from hybrid_rl.outside.learner import transition
from hybrid_rl.outside.row_log import RowLog
from hybrid_rl.thesis.studies.recorded import read as recorded
from hybrid_rl.types import Spec

ARGUMENTS = (
    Argument("faults", 40, "in processes and files", whole()),
    Argument("faulty", 0.2, "share of the datagrams", number(0.0)),
    Argument("seed", 0, "of the order", whole(0)),
    Argument("out", "robot_faults.json", "what was found"),
)
KINDS = ("kill the learner", "kill the robot's process", "stop the learner", "unplug the robot")
KINDS += ("stop the robot's process", "damage the parameters", "tear a row")
PATIENCE = 3.0  # until decisions are taken again, in times of the first start of both processes
LEAST_S = 60.0  # of patience


class Trial:
    """A run, its stand-in, and what happens to them."""

    def __init__(self, faulty: float, seed: int) -> None:
        """Start both."""
        self.folder = Path(mkdtemp()) / "run"
        self.random, port = random.Random(seed), random.randint(20000, 40000)
        python = [sys.executable, "-m"]
        line = ["hybrid_rl.stand_in", "robot=cartpole", f"port={port}", f"faulty={faulty}"]
        self.console = open(self.folder.parent / "console", "w")  # noqa: SIM115
        self.stand = subprocess.Popen([*python, *line], stdout=subprocess.PIPE, text=True)
        make = "env.make=hybrid_rl.envs.adapters.stand_in:Cartpole"
        self.line = [*python, "hybrid_rl.train", "task=robot", make, f"env.kwargs={{port:{port}}}"]
        self.line += ["algo=sac", "settings=light", "random_steps=200", "episode.steps=200"]
        self.line += ["total_steps=100000", "checkpoint_every=200", "log_every=100"]
        self.line += [f"run_dir={self.folder}"]
        self.learner = self._learner(self.line)
        self.patience = float("inf")  # [s]

    def start(self) -> float:
        """[s] until the first decisions, which a busy machine makes long; sets the patience."""
        seconds = self.again()
        self.patience = max(LEAST_S, PATIENCE * seconds)
        return seconds

    def _learner(self, line: list[str]) -> subprocess.Popen:
        return subprocess.Popen(line, stdout=self.console, stderr=self.console)

    def rows(self) -> int:
        """Decisions so far."""
        file = self.folder / "robot" / "rows"
        size = RowLog(file, SPEC).kind.itemsize if file.parent.is_dir() else 1
        return file.stat().st_size // size if file.exists() else 0

    def robot(self) -> int:
        """The robot's process, which may be about to start."""
        line, began = ["pgrep", "-f", f"hybrid_rl.robot run={self.folder}"], time.monotonic()
        while time.monotonic() - began < self.patience and self.learner.poll() is None:
            if found := subprocess.run(line, capture_output=True, text=True).stdout:
                return int(found.split()[0])
            time.sleep(0.1)
        raise SystemExit(f"no robot's process; see {self.console.name}")

    def again(self) -> float:
        """[s] until 30 more decisions are taken; infinite if none come, or the learner ended."""
        first, began = self.rows(), time.monotonic()
        while time.monotonic() - began < self.patience and self.learner.poll() is None:
            if self.rows() >= first + 30:
                return time.monotonic() - began
            time.sleep(0.05)
        return float("inf")

    def fault(self, kind: str) -> None:
        """Make a fault, one of KINDS."""
        match kind:
            case "kill the learner":
                self.learner.kill()
                self.learner.wait()
                time.sleep(self.random.uniform(0, 2))
                saved = (self.folder / "checkpoints").is_dir()
                resume = [*self.line[:3], f"resume={self.folder}"]
                if not saved:
                    shutil.rmtree(self.folder)
                self.learner = self._learner(resume if saved else self.line)
            case "kill the robot's process":
                os.kill(self.robot(), signal.SIGKILL)
            case "stop the learner" | "stop the robot's process":
                who = self.learner.pid if "learner" in kind else self.robot()
                os.kill(who, signal.SIGSTOP)
                time.sleep(self.random.uniform(0.1, 3))
                os.kill(who, signal.SIGCONT)
            case "unplug the robot":
                self.stand.send_signal(signal.SIGSTOP)
                time.sleep(self.random.uniform(0.5, 5))
                self.stand.send_signal(signal.SIGCONT)
            case "damage the parameters":
                file = self.folder / "robot" / "parameters"
                data = file.read_bytes()
                file.write_bytes(data[: self.random.randrange(len(data))])
            case "tear a row":
                os.kill(self.robot(), signal.SIGKILL)
                with open(self.folder / "robot" / "rows", "ab") as file:
                    file.write(os.urandom(self.random.randrange(1, 90)))

    def end(self) -> dict[str, Any]:
        """Stop both; what the files hold."""
        self.learner.send_signal(signal.SIGINT)
        code = self.learner.wait(self.patience)
        self.stand.terminate()
        report = self.stand.communicate()[0].strip().splitlines()[-1]
        log, sound = RowLog(self.folder / "robot" / "rows", SPEC), 0
        while log.read(sound) is not None:
            sound += 1
        rows = [log.read(i) for i in range(sound)]
        bounded = all(np.abs(row["action"]).max() <= 1 for row in rows if row is not None)
        memory, lag = recorded(self.folder), known_lag(ENV, self.folder / "robot")
        made, same = memory.made, 0
        for i in range(memory.decisions):
            row = rows[i]
            assert row is not None
            kept = transition(row, lag)
            pairs = (made.obs, kept.obs), (made.action, kept.action)
            same += all(np.array_equal(ours[0, i], theirs[0, 0]) for ours, theirs in pairs)
        return {
            "exit": code,
            "rows": sound,
            "torn": self.rows() - sound,
            "bounded": bounded,
            "in_memory": memory.decisions,
            "equal": same,
            "stand_in": report,
        }


SPEC = Spec(Cartpole.obs, len(Cartpole.low), Cartpole.dt)
ENV = Robot(make="hybrid_rl.envs.adapters.stand_in:Cartpole")


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    trial = Trial(given["faulty"], given["seed"])
    faults = []
    print(f"first decisions after {trial.start():.1f} s", flush=True)
    for i in range(given["faults"]):
        kind = trial.random.choice(KINDS)
        trial.fault(kind)
        faults.append([kind, round(trial.again(), 2)])
        print(f"{i + 1}: {kind}: decisions again after {faults[-1][1]} s", flush=True)
        time.sleep(trial.random.uniform(0, 2))
    found = {"faults": faults, **trial.end()}
    Path(given["out"]).write_text(json.dumps(found, indent=1))
    print({name: value for name, value in found.items() if name != "faults"})


if __name__ == "__main__":
    main()
