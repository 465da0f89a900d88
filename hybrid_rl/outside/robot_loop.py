"""Training on a robot: rows come at the robot's rate, updates at the device's.

    a row waits?          observe, in up to half of the time while updates are owed
    an update is owed?    learn
    every `handover_s`    publish the newest parameters

`actor` is the robot's process. The step of a run counts the decisions that were learned from, so a
resumed learner makes the updates that it owes, and loses no row that came in the meantime.
"""

import sys
import time
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import jax
import numpy as np
from jax import Array

from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.errors import WorldError
from hybrid_rl.files.atomic import own_folder
from hybrid_rl.outside import handover
from hybrid_rl.outside.lag import FOLLOWED, estimated, followed, known_lag, publish
from hybrid_rl.outside.learner import RowLearner, RowLoop
from hybrid_rl.outside.robot_process import RobotProcess
from hybrid_rl.outside.row_log import RowLog
from hybrid_rl.training.agent import AgentState, update_schedule
from hybrid_rl.training.ahead import AheadController

RESUMED = "the robot went on, or begins a new episode: its rows so far are read first, and the "
RESUMED += "decisions after them differ from those of a run without the interruption"
POLL_S = 5e-4  # [s]
OWN = {"late_s": "late", "age_s": "age", "missed": "missed", "unsafe": "unsafe"}  # of a row
KNOWN = ("obs", "next_obs", "sent", "times", "interval")  # of rows, from which a lag is estimated
LATE_S = 10.0  # [s] of the robot's time that a learner is behind when it first says so


@dataclass
class RobotLoop(RowLoop):
    """Trains one learner on one robot, whose files are in `folder`."""

    notes = (RESUMED,)
    folder: Path = field(default_factory=Path)
    cut: bool = False  # whether a call ends early
    program: "RobotProgram | None" = field(default=None, init=False)

    def compile(self, state: AgentState) -> "RobotProgram":
        """The program (state, first step, rounds) -> (state, metrics)."""
        self.program = RobotProgram(self, state)
        return self.program

    def cut_short(self) -> None:
        """End the present call of the program after its present row."""
        self.cut = True

    def close(self) -> None:
        """End the robot's motion, and its process."""
        if self.program is not None:
            self.program.process.stop()


class RobotProgram:
    """What trains: (state, first step, rounds) -> (state, metrics [n, S, ...]), n <= rounds."""

    def __init__(self, loop: RobotLoop, state: AgentState) -> None:
        """Compile, and open the rows."""
        env = loop.agent.episode.env
        assert isinstance(env, Robot)
        self.loop, self.env = loop, env
        self.log = RowLog(own_folder(loop.folder) / "rows", env.spec)
        self.learner = RowLearner(loop, state, self.log.read)
        self.memory_analysis = self.learner.programs[1].memory_analysis
        self.process = RobotProcess(env, loop.folder)
        self.published, self.reported, self.asked = 0.0, LATE_S / 2, 0
        control = loop.agent.controller
        self.model = control.model if isinstance(control, AheadController) else None
        self.predict = jax.jit(jax.vmap(self._predicted, (None, 0, 0)))
        self.room: int | None = None  # rows that fit into the memory; None before the first call

    def __call__(self, state: AgentState, start: Array, rounds: Array) -> tuple[AgentState, Any]:
        """Train for some rounds, as the program of `Loop`.

        If the robot's class is wrong, or the robot does not answer for long, it ends early, and the
        loop has the `fault`.
        """
        learner, first, count, until = self.learner, int(start), int(rounds), 0.0
        learner.state, learner.learned, began, host, updates = state, first, time.monotonic(), [], 0
        learner.clear()
        if self.room is None:
            self.room = self._resumed(first)
        most = max(first + count, self.room)
        while len(host) < count and not self.loop.cut:
            now = time.monotonic()
            reads = not learner.owes or (learner.read < most and now < until)
            self._take_lag()
            if reads and learner.observe():
                self.process.tries = 0
            elif learner.owes:
                row, updates = learner.learn(len(host)), updates + self._due(first + len(host))
                lag = ((learner.lag or 0.0) + row["age"]) / self.env.spec.dt
                host.append([*(row[name] for name in OWN.values()), lag])
                until = 0.0 if learner.in_order else 2 * time.monotonic() - now
            else:
                self.loop.cut |= self.process.ended
                time.sleep(POLL_S)
            if time.monotonic() - self.published > self.env.handover_s:
                newest = learner.params(), learner.learned
                handover.publish(self.loop.folder / "parameters", *newest)
                self.published = time.monotonic()
                self._watch()
        behind = self.log.count() - learner.learned
        self._say(behind)
        rate = updates / max(time.monotonic() - began, 1e-9)
        own = [[*row, rate, behind] for row in host]
        return learner.state, self._metrics(own)

    def _resumed(self, step: int) -> int:
        """Count the rows in the memory, perhaps more than `step`; how many fit into it."""
        agent, memory = self.loop.agent, self.learner.state.memory
        held, given = int(memory.count[0]), agent.replay.num_demonstrated(1)
        self.learner.read = max(step, held - given - max(-agent.first_update, 0))
        return self.learner.read + memory.rows.shape[1] - held

    def _take_lag(self) -> None:
        """Learn from what acted, once it is known how late: given, or by all random decisions.

        Then follow it, unless it was given, by a model of single observations (no history).
        """
        learner, folder, count = self.learner, self.loop.folder, self.loop.agent.random_steps
        if learner.lag is None and learner.read >= count:
            if (lag := known_lag(self.env, folder)) is None:
                rows = np.array([*map(self.log.read, range(count))])
                lag = estimated(*(rows[name] for name in KNOWN)) if count else 0.0
                publish(folder, lag)
            self._learn_by(lag)
        elif learner.lag is not None and self.env.lag is None and self.model is not None:
            if learner.read < max(self.asked, count) + FOLLOWED:
                return
            self.asked = learner.read
            rows = np.array([*map(self.log.read, range(self.asked - FOLLOWED, self.asked))])
            model = partial(self.predict, learner.params().model)
            if (lag := followed(model, rows, learner.lag)) != learner.lag:
                publish(folder, lag)
                self._learn_by(lag, FOLLOWED)

    def _learn_by(self, lag: float, newest: int | None = None) -> None:
        """Learn by a lag [s] from now on, and from the newest decisions, and say so."""
        self.learner.relabel(lag, newest)
        line = f"an action acts {1e3 * lag:.0f} ms after it is sent"
        print(f"hybrid_rl: {self.env.name}: {line}", file=sys.stderr, flush=True)

    def _predicted(self, params: Any, obs: Array, u: Array) -> Array:
        """The observation [o] after u [m] acted at obs [o], by the model."""
        assert self.model is not None
        return self.model.step(params, self.model.lift(params, obs), u)[: obs.size]

    def _due(self, step: int) -> int:
        """Gradient steps of all learners after decision `step`."""
        agent, due = self.loop.agent, 0
        for name, start in agent.starts().items():
            count, every = update_schedule(name, agent.learners[name], 1)
            due += count * (name not in agent.frozen and step >= start and step % every == 0)
        return due

    def _watch(self) -> None:
        """See to the robot's process."""
        try:
            self.process.watch()
        except WorldError as error:
            if not self.learner.learned:
                raise
            self.loop.fault, self.loop.cut = error, True

    def _say(self, behind: int) -> None:
        """Print that the learner is behind, and again when it is twice as much."""
        seconds = behind * self.env.spec.dt
        if seconds >= 2 * self.reported:
            self.reported = seconds
            line = f"the learner is {behind:,} decisions ({seconds:.0f} s) behind the robot"
            print(f"hybrid_rl: {line}", file=sys.stderr, flush=True)

    def _metrics(self, own: list[list[float]]) -> dict[str, np.ndarray]:
        """The rows of this call, with the robot's own numbers."""
        names = [*OWN, "lag", "updates_per_s", "behind"]
        table = np.array(own, np.float32).reshape(len(own), len(names), 1)
        rows = {name: row[: len(own)] for name, row in jax.device_get(self.learner.metrics).items()}
        return rows | {f"robot/{name}": table[:, k] for k, name in enumerate(names)}
