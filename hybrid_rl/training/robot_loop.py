"""Training on a robot: rows come at the robot's rate, updates at the device's.

    row = next of the robot's process?   observe: into the memory
    none yet?                            learn: the updates of one decision, at most one per row
    every `handover_s`                   publish: the newest parameters

`training.actor` is the robot's process. Row n is decision n of the run, so that a resumed learner
goes on behind the last row of its checkpoint, and loses none that came in the meantime.
"""

import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core.batching import where
from hybrid_rl.data import handover
from hybrid_rl.data.row_log import RowLog
from hybrid_rl.envs.adapters.copies import Outcome
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.errors import WorldError
from hybrid_rl.training.actor import check_one
from hybrid_rl.training.agent import AgentState
from hybrid_rl.training.host_loop import outcome_like, states
from hybrid_rl.training.loop import METRICS, REPLICATED, SEEDS, Loop, put
from hybrid_rl.training.metrics import outcome
from hybrid_rl.training.robot_process import RobotProcess

RESUMED = "the robot went on, or begins a new episode: its rows so far are read first, and the "
RESUMED += "decisions after them differ from those of a run without the interruption"
POLL_S = 5e-4  # [s]


@dataclass
class RobotLoop(Loop):
    """Trains one learner on one robot, whose files are in `folder`."""

    notes = (RESUMED,)
    folder: Path = field(default_factory=Path)
    cut: bool = False  # whether a call ends early
    rows: Any = field(default=None, init=False)  # shapes [stride, S, ...] of the metrics of a call

    def __post_init__(self) -> None:
        check_one(self.agent, self.seeds)

    def trace(self, state: AgentState) -> list[Any]:
        """The traces of the programs that observe and that learn."""
        began, zero, no = time.perf_counter(), np.int32(0), np.bool_(False)
        got = outcome_like(state.env)
        action = jnp.zeros((*got.obs.shape[:-1], self.agent.spec.act))
        now = jax.eval_shape(jax.vmap(self._observed), state, action, got)[1]
        learned = jax.eval_shape(jax.vmap(self.agent.learn, (0, None)), state, zero)[1]
        self.rows = self.rows_of({**now, **learned})
        parts = (SEEDS, METRICS, SEEDS, SEEDS, *[REPLICATED] * 3), (SEEDS, METRICS)
        observe = self.shard(self._observe, *parts, donate_argnums=(0, 1))
        parts = (SEEDS, METRICS, REPLICATED, REPLICATED), (SEEDS, METRICS)
        learn = self.shard(self._learn, *parts, donate_argnums=(0, 1))
        traced = [
            observe.trace(state, self.rows, action, got, no, no, zero),
            learn.trace(state, self.rows, zero, zero),
        ]
        self.compile_s += time.perf_counter() - began
        return traced

    def compile(self, state: AgentState) -> "RobotProgram":
        """The program (state, first step, rounds) -> (state, metrics)."""
        self.program = RobotProgram(self, *self.halves(state))
        return self.program

    def halves(self, state: AgentState) -> list[Any]:
        """The compiled programs that observe and that learn; both donate state and rows."""
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

    def _observed(
        self, state: AgentState, action: Array, got: Outcome
    ) -> tuple[AgentState, dict[str, Array]]:
        """One learner with a decision more in its memory, and what it led to."""
        now, after = states(state.env, got)
        return self.agent.observe(state, action, now, after), outcome(action, now)

    def _observe(
        self, state: Any, rows: Any, action: Array, got: Outcome, gap: Array, first: Array, i: Array
    ) -> tuple[Any, Any]:
        """All learners with a decision more, and its metrics in row i.

        gap: whether decisions are missing before it; first: whether it begins an episode.
        `got.following` is the observation before the decision.
        """

        def one(state: AgentState, action: Array, got: Outcome) -> tuple[AgentState, Any]:
            cut = self.agent.replay.interrupted(state.memory, self.agent.spec)
            clock = jax.tree.map(lambda x: jnp.where(first, 0, x).astype(x.dtype), state.env.clock)
            env = state.env.replace(obs=got.following, clock=clock)
            state = state.replace(env=env, memory=where(gap, cut, state.memory))
            return self._observed(state, action, got)

        state, metrics = jax.vmap(one)(state, action, got)
        return state, put(rows, metrics, i)

    def _learn(self, state: Any, rows: Any, i: Array, step: Array) -> tuple[Any, Any]:
        """All learners after the updates of decision `step`, with their metrics in row i."""
        state, metrics = jax.vmap(self.agent.learn, (0, None))(state, step)
        return state, put(rows, metrics, i)


def packed(
    action: Any, next_obs: Any, reward: Any, terminated: Any, truncated: Any, obs: Any
) -> Any:
    """(action [1, 1, m], outcome [1, 1, ...]) of one decision, for the program that observes."""

    def each(value: Any, kind: type = np.float32) -> np.ndarray:
        return np.array(value, kind)[None, None]  # [S, E, ...]; a copy

    ends = each(terminated, bool), each(truncated, bool)
    return each(action), Outcome(each(next_obs), each(reward), *ends, each(obs))


def flags(gap: bool, first: bool, i: int) -> tuple[Any, ...]:
    """The last arguments of the program that observes."""
    return np.bool_(gap), np.bool_(first), np.int32(i)


class RobotProgram:
    """What trains: (state, first step, rounds) -> (state, metrics [n, S, ...]), n <= rounds."""

    def __init__(self, loop: RobotLoop, observe: Any, learn: Any) -> None:
        """observe, learn: the compiled halves."""
        self.loop, self.observe, self.learn = loop, observe, learn
        self.memory_analysis = learn.memory_analysis
        env = loop.agent.episode.env
        assert isinstance(env, Robot)
        self.env, self.published = env, 0.0
        self.in_order = any(each.data == "latest" for each in loop.agent.learners.values())
        self.process = RobotProcess(env, loop.folder)
        self.log: RowLog | None = None  # opened at the first call
        self.learned = 0  # decisions that were learned from
        self.last: Any = None  # the row before

    def __call__(self, state: AgentState, start: Array, rounds: Array) -> tuple[AgentState, Any]:
        """As the program of `Loop`.

        If the robot's class is wrong, or the robot does not answer for long, it ends early, and the
        loop has the `fault`.

        Raises:
            WorldError: of that kind, before the first decision of the run.
        """
        first, count, done, began = int(start), int(rounds), 0, time.monotonic()
        if self.log is None:
            self.log, self.learned = RowLog(self.loop.folder / "rows", self.env.spec), first
            self.last = self.log.read(first - 1) if first else None
        rows: Any = self.loop.empty()
        host, updates = [], 0
        while done < count and not self.loop.cut:
            row = self.log.read(first + done)
            if row is not None:
                state, rows = self._into(state, rows, row, done)
                host.append([row["late"], row["age"], row["missed"], row["unsafe"]])
                self.process.tries, done = 0, done + 1
            if (row is None or self.in_order) and self.learned < first + done:
                at = np.int32(self.learned), np.int32(max(done - 1, 0))
                state, rows = self.learn(state, rows, at[1], at[0])
                jax.block_until_ready(state.key)
                self.learned, updates = self.learned + 1, updates + 1
            elif row is None:
                try:
                    self.process.watch()
                except WorldError as error:
                    if not first + done:
                        raise
                    self.loop.fault = error
                self.loop.cut |= self.process.ended or self.loop.fault is not None
                time.sleep(POLL_S)
            if time.monotonic() - self.published > self.env.handover_s:
                self._publish(state, first + done)
        seconds = max(time.monotonic() - began, 1e-9)
        return state, self._metrics(jax.device_get(rows), done, host, updates / seconds)

    def _into(self, state: Any, rows: Any, row: Any, i: int) -> tuple[Any, Any]:
        """The row in the memory of the learner."""
        last, self.last = self.last, row
        gap = first = False
        if last is not None:
            gap = not (last["terminated"] or last["truncated"]) and last["stretch"] < row["stretch"]
            first = last["episode"] != row["episode"]
        got = (row[name] for name in ("next_obs", "reward", "terminated", "truncated", "obs"))
        return self.observe(state, rows, *packed(row["action"], *got), *flags(gap, first, i))

    def _publish(self, state: Any, version: int) -> None:
        params = jax.vmap(self.loop.agent.params)(state)
        one = jax.tree.map(lambda leaf: np.asarray(leaf)[0], params)
        handover.publish(self.loop.folder / "parameters", one, version)
        self.published = time.monotonic()

    def _metrics(self, rows: Any, done: int, host: list, rate: float) -> Any:
        """The rows of this call, with the robot's own numbers."""
        table = np.array(host, np.float32).reshape(done, 4, 1)
        names = ("late_s", "age_s", "missed", "unsafe")
        own = {f"robot/{name}": table[:, k] for k, name in enumerate(names)}
        own["robot/updates_per_s"] = np.full((done, 1), rate, np.float32)
        return {name: row[:done] for name, row in rows.items()} | own
