"""A learner of rows, which others write: a robot's process, or a loop of the user's.

    observe   the next row enters the memory
    learn     the updates of the first decision that was not learned from

Row n is decision n of the run. The memory may be ahead of what was learned from, and the rows ahead
of the memory. `transition` is where a row becomes one.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.data.replay import Memory
from hybrid_rl.errors import UsageError
from hybrid_rl.outside.acting import next_state
from hybrid_rl.outside.lag import acted
from hybrid_rl.outside.row_log import row_type
from hybrid_rl.training.agent import AgentState
from hybrid_rl.training.loop import METRICS, REPLICATED, SEEDS, Loop, put
from hybrid_rl.training.metrics import outcome
from hybrid_rl.types import Params, PyTree, Transition


@dataclass
class RowLoop(Loop):
    """The programs of one learner of rows."""

    rows: PyTree = field(default=None, init=False)  # shapes [stride, S, ...] of a call's metrics

    def __post_init__(self) -> None:
        if (given := (len(self.seeds), self.agent.num_envs)) != (1, 1):
            line = f"num_seeds={given[0]}, num_envs={given[1]}: one robot has one learner"
            raise UsageError(f"{line}; give 1 and 1, and sweep by -m")

    def trace(self, state: AgentState) -> list[Any]:
        """The traces of the programs that observe and that learn."""
        zero, no = np.int32(0), np.bool_(False)
        made = transition(np.zeros((), row_type(self.agent.spec)))
        learned = jax.vmap(self._learned, (0, 0, None, None))
        self.rows = self.rows_of(jax.eval_shape(learned, state, made, no, zero)[1])
        parts = (SEEDS, SEEDS, REPLICATED), SEEDS
        observe = self.shard(jax.vmap(self._observed, (0, 0, None)), *parts, donate_argnums=0)
        parts = (SEEDS, METRICS, REPLICATED, SEEDS, REPLICATED, REPLICATED), (SEEDS, METRICS)
        learn = self.shard(self._learn, *parts, donate_argnums=(0, 1))
        return [
            observe.trace(state.memory, made, no),
            learn.trace(state, self.rows, zero, made, no, zero),
        ]

    def halves(self, state: AgentState) -> list[Any]:
        """The compiled programs that observe and that learn.

        (memory, made, gap) -> memory, and (state, rows, i, made, first, step) -> (state, rows): of
        decision `step`, with its metrics in row i. made: a Transition [1, 1, ...]; gap: whether
        decisions are missing before it; first: whether it begins an episode. What comes back is
        donated.
        """
        return list(map(self.compile_trace, self.trace(state)))

    def _observed(self, memory: Memory, made: Transition, gap: Array) -> Memory:
        """The memory of one learner with a decision more."""
        replay, spec = self.agent.replay, self.agent.spec
        ended = jax.lax.cond(gap, lambda m: replay.interrupted(m, spec), lambda m: m, memory)
        return replay.add(ended, made)

    def _learned(
        self, state: AgentState, made: Transition, first: Array, step: Array
    ) -> tuple[AgentState, dict[str, Array]]:
        """One learner after the updates of a decision, and what that one led to."""
        clock = jax.tree.map(lambda x: jnp.where(first, 0, x).astype(x.dtype), state.env.clock)
        before = state.env.replace(clock=clock)
        now = next_state(before, made.next_obs, made.reward, made.terminated, made.truncated)
        state, metrics = self.agent.learn(state.replace(env=now), step)
        return state, {**metrics, **outcome(made.action, now)}

    def _learn(self, state: Any, rows: Any, i: Array, *made: Any) -> tuple[Any, Any]:
        """All learners after the updates of a decision, with its metrics in row i."""
        state, metrics = jax.vmap(self._learned, (0, 0, None, None))(state, *made)
        return state, put(rows, metrics, i)


def transition(row: Any, lag: float | None = None) -> Transition:
    """The decision of a row, [1, 1, ...], for the two programs.

    lag: [s] from sending an action until it acts, of a robot, for the mean of those that acted;
    None: the row's own action.
    """
    ends = ("terminated", "truncated")
    kinds = {name: bool if name in ends else np.float32 for name in Transition._fields}
    made: Any = {name: np.array(row[name], kind)[None, None] for name, kind in kinds.items()}
    if lag is not None:
        u = acted(row["sent"], row["times"], row["interval"], lag)
        made["action"] = u.astype(np.float32)[None, None]
    return Transition(**made)


class RowLearner:
    """The state of a learner, and how far it has come in the rows."""

    def __init__(self, loop: RowLoop, state: AgentState, row_at: Callable[[int], Any]) -> None:
        """Compile; row_at: a row by its number, None if it is not there."""
        self.loop, self.state, self.row_at = loop, state, row_at
        self.programs = loop.halves(state)
        self.in_order = any(each.data == "latest" for each in loop.agent.learners.values())
        self.read = self.learned = 0  # rows in the memory, and those that were learned from
        self.lag: float | None = None  # [s] of `transition`
        self.clear()

    def clear(self) -> None:
        """Empty rows [stride, 1, ...] for metrics."""
        self.metrics: Any = {
            name: np.full(row.shape, np.nan if row.dtype.kind == "f" else 0, row.dtype)
            for name, row in self.loop.rows.items()
        }

    @property
    def owes(self) -> bool:
        """Whether a row in the memory was not learned from."""
        return self.read > self.learned

    def observe(self) -> bool:
        """Take the next row into the memory, if it is there."""
        row, before = self.row_at(self.read), self.row_at(self.read - 1)
        if row is None:
            return False
        gap = np.bool_(before is None or before["stretch"] != row["stretch"])
        memory = self.programs[0](self.state.memory, transition(row, self.lag), gap)
        self.state = self.state.replace(memory=jax.block_until_ready(memory))
        self.read += 1
        return True

    def relabel(self, lag: float, newest: int | None = None) -> None:
        """Learn from what acted by a lag [s] from now on, also in the memory.

        newest: how many decisions of the memory; None: all.
        """
        self.lag, memory, o = lag, self.state.memory, self.loop.agent.spec.obs
        rows, size = np.array(memory.rows), memory.rows.shape[1]
        for number in range(max(self.read - min(newest or size, size), 0), self.read):
            u = transition(self.row_at(number), lag).action[0, 0]
            slot = (int(memory.count[0]) - self.read + number) % size
            rows[0, slot, 0, o : o + len(u)] = u
        self.state = self.loop.on_devices(self.state.replace(memory=memory.replace(rows=rows)))

    def learn(self, i: int = 0) -> Any:
        """Make the updates of a decision, with its metrics in row i; returns its row."""
        row, before = self.row_at(self.learned), self.row_at(self.learned - 1)
        first = np.bool_(before is None or before["episode"] != row["episode"])
        given = np.int32(i), transition(row, self.lag), first, np.int32(self.learned)
        self.state, self.metrics = self.programs[1](self.state, self.metrics, *given)
        jax.block_until_ready(self.state.key)
        self.learned += 1
        return row

    def params(self) -> Params:
        """A copy of the newest parameters."""
        params = jax.vmap(self.loop.agent.params)(self.state)
        return jax.tree.map(lambda leaf: np.array(leaf)[0], params)
