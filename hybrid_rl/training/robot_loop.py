"""Training on a robot: rows come at the robot's rate, updates at the device's.

    a row waits?          observe: into the memory, in up to half of the time while updates are owed
    an update is owed?    learn: the updates of the first decision that was not learned from
    every `handover_s`    publish: the newest parameters

`training.actor` is the robot's process. Row n is decision n of the run, and its step counts those
that were learned from: the memory may be ahead, and the file ahead of the memory. So a resumed
learner makes the updates that it owes, and loses no row that came in the meantime.
"""

import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.data import handover
from hybrid_rl.data.replay import Memory
from hybrid_rl.data.row_log import RowLog
from hybrid_rl.envs.adapters.copies import Outcome
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.errors import WorldError
from hybrid_rl.training.actor import check_one
from hybrid_rl.training.agent import AgentState, update_schedule
from hybrid_rl.training.host_loop import outcome_like, states
from hybrid_rl.training.loop import METRICS, REPLICATED, SEEDS, Loop, put
from hybrid_rl.training.metrics import outcome
from hybrid_rl.training.robot_process import RobotProcess
from hybrid_rl.types import PyTree, Transition

RESUMED = "the robot went on, or begins a new episode: its rows so far are read first, and the "
RESUMED += "decisions after them differ from those of a run without the interruption"
POLL_S = 5e-4  # [s]
OWN = {"late_s": "late", "age_s": "age", "missed": "missed", "unsafe": "unsafe"}  # of a row
LATE_S = 10.0  # [s] of the robot's time that a learner is behind when it first says so


@dataclass
class RobotLoop(Loop):
    """Trains one learner on one robot, whose files are in `folder`."""

    notes = (RESUMED,)
    folder: Path = field(default_factory=Path)
    cut: bool = False  # whether a call ends early
    rows: PyTree = field(default=None, init=False)  # shapes [stride, S, ...] of a call's metrics

    def __post_init__(self) -> None:
        check_one(self.agent, self.seeds)

    def trace(self, state: AgentState) -> list[Any]:
        """The traces of the programs that observe and that learn."""
        began, zero, no = time.perf_counter(), np.int32(0), np.bool_(False)
        got = outcome_like(state.env)
        action = jnp.zeros((*got.obs.shape[:-1], self.agent.spec.act))
        learned = jax.vmap(self._learned, (0, 0, 0, None, None))
        self.rows = self.rows_of(jax.eval_shape(learned, state, action, got, no, zero)[1])
        parts = (SEEDS, SEEDS, SEEDS, REPLICATED), SEEDS
        observe = self.shard(jax.vmap(self._observed, (0, 0, 0, None)), *parts, donate_argnums=0)
        parts = (SEEDS, METRICS, REPLICATED, SEEDS, SEEDS, REPLICATED, REPLICATED), (SEEDS, METRICS)
        learn = self.shard(self._learn, *parts, donate_argnums=(0, 1))
        traced = [
            observe.trace(state.memory, action, got, no),
            learn.trace(state, self.rows, zero, action, got, no, zero),
        ]
        self.compile_s += time.perf_counter() - began
        return traced

    def compile(self, state: AgentState) -> "RobotProgram":
        """The program (state, first step, rounds) -> (state, metrics)."""
        self.program = RobotProgram(self, *self.halves(state))
        return self.program

    def halves(self, state: AgentState) -> list[Any]:
        """The compiled programs that observe and that learn.

        (memory, action, outcome, gap) -> memory, and (state, rows, i, action, outcome, first, step)
        -> (state, rows): of decision `step`, with its metrics in row i. gap: whether decisions are
        missing before it; first: whether it begins an episode. What comes back is donated.
        """
        return list(map(self.compile_trace, self.trace(state)))

    def empty(self) -> dict[str, np.ndarray]:
        """Rows [stride, S, ...] for the metrics of a call."""
        return {
            name: np.full(row.shape, np.nan if row.dtype.kind == "f" else 0, row.dtype)
            for name, row in self.rows.items()
        }

    def cut_short(self) -> None:
        """End the present call of the program after its present row."""
        self.cut = True

    def close(self) -> None:
        """End the robot's motion, and its process."""
        if hasattr(self, "program"):
            self.program.process.stop()

    def _observed(self, memory: Memory, action: Array, got: Outcome, gap: Array) -> Memory:
        """The memory of one learner with a decision more."""
        replay, spec = self.agent.replay, self.agent.spec
        memory = jax.lax.cond(
            gap, lambda old: replay.interrupted(old, spec), lambda old: old, memory
        )
        led: Any = got.reward, got.terminated, got.truncated, got.obs
        before: Any = got.following
        return replay.add(memory, Transition(before, action, *led))

    def _learned(
        self, state: AgentState, action: Array, got: Outcome, first: Array, step: Array
    ) -> tuple[AgentState, dict[str, Array]]:
        """One learner after the updates of a decision, and what that one led to.

        `got.following` is the observation before the decision.
        """
        clock = jax.tree.map(lambda x: jnp.where(first, 0, x).astype(x.dtype), state.env.clock)
        now, after = states(state.env.replace(obs=got.following, clock=clock), got)
        state, metrics = self.agent.learn(state.replace(env=after), step)
        return state, {**metrics, **outcome(action, now)}

    def _learn(self, state: Any, rows: Any, i: Array, *decision: Any) -> tuple[Any, Any]:
        """All learners after the updates of a decision, with its metrics in row i."""
        state, metrics = jax.vmap(self._learned, (0, 0, 0, None, None))(state, *decision)
        return state, put(rows, metrics, i)


def packed(
    action: Any, next_obs: Any, reward: Any, terminated: Any, truncated: Any, obs: Any
) -> Any:
    """(action [1, 1, m], outcome [1, 1, ...]) of one decision, for the two programs."""

    def each(value: Any, kind: type = np.float32) -> np.ndarray:
        return np.array(value, kind)[None, None]  # [S, E, ...]; a copy

    ends = each(terminated, bool), each(truncated, bool)
    return each(action), Outcome(each(next_obs), each(reward), *ends, each(obs))


class RobotProgram:
    """What trains: (state, first step, rounds) -> (state, metrics [n, S, ...]), n <= rounds."""

    def __init__(self, loop: RobotLoop, observe: Any, learn: Any) -> None:
        """observe, learn: the compiled halves."""
        self.loop, self.observe, self.learn = loop, observe, learn
        self.memory_analysis = learn.memory_analysis
        env = loop.agent.episode.env
        assert isinstance(env, Robot)
        self.env, self.published, self.reported = env, 0.0, LATE_S / 2
        self.in_order = any(each.data == "latest" for each in loop.agent.learners.values())
        self.process = RobotProcess(env, loop.folder)
        self.log = RowLog(loop.folder / "rows", env.spec)
        self.read: int | None = None  # rows in the memory
        self.room = 0  # as many as fit into it

    def __call__(self, state: AgentState, start: Array, rounds: Array) -> tuple[AgentState, Any]:
        """As the program of `Loop`.

        If the robot's class is wrong, or the robot does not answer for long, it ends early, and the
        loop has the `fault`.
        """
        first, count, done, began = int(start), int(rounds), 0, time.monotonic()
        rows = self.loop.empty()
        read = self._known(state, first) if self.read is None else self.read
        host, updates, until = [], 0, 0.0
        while done < count and not self.loop.cut:
            at, row = first + done, None
            owed, now = read > at, time.monotonic()
            if not owed or (read < max(first + count, self.room) and now < until):
                row = self.log.read(read)
            if row is not None:
                state = state.replace(memory=self._into(state.memory, row))
                self.process.tries, read = 0, read + 1
            elif owed:
                state, rows, own = self._after(state, rows, at, done)
                host.append(own)
                done, updates = done + 1, updates + self._due(at)
                until = 0.0 if self.in_order else 2 * time.monotonic() - now
            else:
                self.loop.cut |= self.process.ended
                time.sleep(POLL_S)
            if time.monotonic() - self.published > self.env.handover_s:
                self._publish(state, first + done)
                self._watch(first + done)
        self.read, rate = read, updates / max(time.monotonic() - began, 1e-9)
        behind = self.log.count() - first - done
        self._say(behind)
        return state, self._metrics(jax.device_get(rows), host, rate, behind)

    def _known(self, state: AgentState, first: int) -> int:
        """Rows in the memory at the first call; a checkpoint's may go beyond `first`, its step."""
        agent, held = self.loop.agent, int(state.memory.count[0])
        given = agent.replay.num_demonstrated(1) + max(-agent.first_update, 0)
        read = max(first, held - given)
        self.room = read + state.memory.rows.shape[1] - held
        return read

    def _into(self, memory: Memory, row: Any) -> Memory:
        """The memory with a row."""
        gap = False
        if (last := self._before(row)) is not None and last["stretch"] < row["stretch"]:
            gap = not (last["terminated"] or last["truncated"])
        return jax.block_until_ready(self.observe(memory, *_decision(row), np.bool_(gap)))

    def _after(self, state: Any, rows: Any, at: int, i: int) -> tuple[Any, Any, list[float]]:
        """State and rows after the updates of decision `at`, in row i; the robot's own numbers."""
        row: Any = self.log.read(at)
        before = self._before(row)
        first = before is not None and before["episode"] != row["episode"]
        last = np.bool_(first), np.int32(at)
        state, rows = self.learn(state, rows, np.int32(i), *_decision(row), *last)
        jax.block_until_ready(state.key)
        return state, rows, [row[name] for name in OWN.values()]

    def _before(self, row: Any) -> Any:
        """The row before; None before the first."""
        return self.log.read(int(row["number"]) - 1) if row["number"] else None

    def _due(self, step: int) -> int:
        """Gradient steps of all learners after decision `step`."""
        agent, due = self.loop.agent, 0
        for name, start in agent.starts().items():
            count, every = update_schedule(name, agent.learners[name], 1)
            due += count * (name not in agent.frozen and step >= start and step % every == 0)
        return due

    def _watch(self, made: int) -> None:
        """See to the robot's process, after so many decisions."""
        try:
            self.process.watch()
        except WorldError as error:
            if not made:
                raise
            self.loop.fault, self.loop.cut = error, True

    def _publish(self, state: Any, version: int) -> None:
        params = jax.vmap(self.loop.agent.params)(state)
        one = jax.tree.map(lambda leaf: np.asarray(leaf)[0], params)
        handover.publish(self.loop.folder / "parameters", one, version)
        self.published = time.monotonic()

    def _say(self, behind: int) -> None:
        """Print that the learner is behind, and again when it is twice as much."""
        seconds = behind * self.env.spec.dt
        if seconds >= 2 * self.reported:
            self.reported = seconds
            line = f"the learner is {behind:,} decisions ({seconds:.0f} s) behind the robot; "
            line += "settings=light, fewer updates or less load on this machine make it faster"
            print(f"hybrid_rl: {line}", file=sys.stderr, flush=True)

    def _metrics(self, rows: Any, host: list, rate: float, behind: int) -> Any:
        """The rows of this call, with the robot's own numbers."""
        done = len(host)
        table = np.array(host, np.float32).reshape(done, len(OWN), 1)
        own = {f"robot/{name}": table[:, k] for k, name in enumerate(OWN)}
        own["robot/updates_per_s"] = np.full((done, 1), rate, np.float32)
        own["robot/behind"] = np.full((done, 1), behind, np.float32)
        return {name: row[:done] for name, row in rows.items()} | own


def _decision(row: Any) -> Any:
    got = (row[name] for name in ("next_obs", "reward", "terminated", "truncated", "obs"))
    return packed(row["action"], *got)
