"""The checkpoints of a run: the learners' state, its record, and the metrics since the last row."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.errors import MisfitError
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.logs.log import RunLog
from hybrid_rl.run.logs.records import Row
from hybrid_rl.run.logs.rows import Gathered
from hybrid_rl.run.schedule import Speed
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.loop import Loop

# {"seed", "step", "quantity"} of a learner that diverged; "of": its numbers, where a program has
# several sets of them
End = dict[str, Any]


@dataclass
class Record:
    """Progress and results of a run so far; a checkpoint holds it whole."""

    returns: list[list[tuple[int, float]]]  # per learner: (step, return)
    final_eval: list[float | None]  # per learner: the latest
    step: int = 0  # decisions of each learner
    wall_s: float = 0.0  # [s] in earlier sessions; of a checkpoint: until then
    metrics_bytes: int = 0  # of a checkpoint: the size of metrics.jsonl then
    learning: Speed = field(default_factory=Speed)  # over all sessions
    unevaluated: bool = False  # an evaluation is due at `step`
    ends: list[End] = field(default_factory=list)  # of learners that diverged


def with_capacity(agent: Agent, capacity: int) -> Agent:
    """The agent with a replay memory of that capacity."""
    return replace(agent, replay=replace(agent.replay, capacity=capacity))


def read_part(
    folder: Path, agent: Agent, seeds: tuple[int, ...], part: str, step: int | None = None
) -> tuple[int, Any, list[str]]:
    """(step, AgentState [S, ...], notes) of the newest sound checkpoint, or the one at `step`.

    part: the field of the state that is read; the others are None.
    """
    saved = checkpoint.meta(folder).get("seeds", [*seeds])
    if saved != [*seeds]:
        has, wanted = (", ".join(map(str, each)) for each in (saved, seeds))
        raise MisfitError(f"{folder} holds the learners of seed {has}, not of seed {wanted}")
    like = Loop(agent, seeds, 1).shapes()
    others = {field.name: None for field in fields(like) if field.name != part}
    step, state, _, notes = checkpoint.restore(folder, like.replace(**others), step)
    return step, state, notes


def concatenated(states: Sequence[Any]) -> Any:
    """The trees [S, ...] of the learners of several runs as one."""
    return jax.tree.map(lambda *leaves: jnp.concatenate(leaves), *states)


def by_learner(change: Callable[[Any], Any], memory: Any) -> Any:
    """The results [S, ...] of `change` for the memory of each learner."""
    learners = range(len(memory.count))
    each = [change(jax.tree.map(lambda leaf, s=s: leaf[s], memory)) for s in learners]
    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *each)


@dataclass
class Store:
    """Checkpoints of `loop` in `folder`; replay: whether they hold the replay memory.

    settings: config.yaml by full keys, which each checkpoint repeats.
    """

    folder: Path
    loop: Loop
    replay: bool
    settings: Mapping[str, Any]
    newest: int | None = None  # step of the checkpoint that was written or read last

    def save(self, state: Any, gathered: Gathered, record: Record) -> None:
        """Write a checkpoint of the run."""
        names, array = gathered.pack()
        leaves = {part.name: getattr(state, part.name) for part in fields(state)}
        if not self.replay:
            leaves["memory"] = None
        if array is not None:
            leaves["gathered"] = array
        meta = {
            "seeds": list(self.loop.seeds),
            "capacity": self.loop.agent.replay.capacity,
            "settings": dict(self.settings),
            "gathered": {"names": names, "shape": [] if array is None else list(array.shape)},
            "record": asdict(record),
        }
        checkpoint.save(self.folder, record.step, leaves, meta)
        self.newest = record.step

    def restore(self, step: int | None = None) -> tuple[Any, Gathered, Record, list[str]]:
        """(state, metrics since the last row, record, notes) of the newest sound checkpoint.

        step: of another checkpoint.
        """
        state, meta, notes = self._state(step)
        gathered, packed = Gathered(), meta.get("gathered", {})
        if packed.get("names"):
            like = {"gathered": jax.ShapeDtypeStruct(tuple(packed["shape"]), np.float32)}
            array = checkpoint.restore(self.folder, like, self.newest)[1]["gathered"]
            gathered.unpack(packed["names"], array)
        record = Record(**meta["record"])
        record.learning = Speed(**meta["record"]["learning"])
        return self.loop.on_devices(state), gathered, record, notes

    def learner(self, number: int) -> Any:
        """AgentState [...] of one learner in the newest checkpoint, or else its first one."""
        if self.newest is None:
            return jax.jit(self.loop.agent.init)(jax.random.key(self.loop.seeds[number]))
        return jax.tree.map(lambda leaf: leaf[number], self._state(self.newest)[0])

    def _state(self, step: int | None) -> tuple[Any, dict[str, Any], list[str]]:
        """(state, meta, notes) of a checkpoint; its memory is empty if checkpoints hold none."""
        like = self.loop.shapes().replace(memory=None)
        self.newest, state, meta, notes = checkpoint.restore(self.folder, like, step)
        memory = self._memory(meta["capacity"]) if self.replay else self.loop.init().memory
        return state.replace(memory=memory), meta, notes

    def _memory(self, capacity: int) -> Any:
        """The checkpoint's replay memory, which held `capacity`, in the size that it has now.

        Extending a run may enlarge the memory.
        """
        agent = with_capacity(self.loop.agent, capacity)
        memory = read_part(self.folder, agent, self.loop.seeds, "memory", self.newest)[1].memory
        now = self.loop.agent.replay
        return memory if capacity == now.capacity else by_learner(now.resized, memory)


@dataclass
class Shelf:
    """The records and checkpoints of a program: of its run or, with an axis, of each of K runs.

    Each of the K folders has the rows and the checkpoints of its n learners, as if they were alone;
    `loop` trains all S = K n. logs and stores: [K].
    """

    loop: Loop
    logs: Sequence[RunLog]
    stores: Sequence[Store]

    @property
    def newest(self) -> int | None:
        """The step of the checkpoint that was written or read last."""
        return self.stores[-1].newest

    def shares(self) -> list[slice]:
        """The learners of each folder."""
        size = len(self.loop.seeds) // len(self.logs)
        return [slice(k * size, (k + 1) * size) for k in range(len(self.logs))]

    def write(self, new: Sequence[Row], wall_s: float) -> None:
        """Append rows {"step", "learner", name: number or word, ...}, with the wall time [s]."""
        for log, share in zip(self.logs, self.shares(), strict=True):
            rows = [row.copy() for row in new if share.start <= row["learner"] < share.stop]
            seeds = [self.loop.seeds[row.pop("learner")] for row in rows]
            for row, seed in zip(rows, seeds, strict=True):
                log.write([{"step": row.pop("step"), "seed": seed} | row | {"wall_s": wall_s}])

    def save(self, state: Any, gathered: Gathered, record: Record, ends: Mapping[int, End]) -> None:
        """Write a checkpoint to each folder; as `Store.save`. ends: by the learner's number."""
        parts = gathered.split(len(self.logs))
        for log, store, share, part in zip(
            self.logs, self.stores, self.shares(), parts, strict=True
        ):
            mine = replace(
                record,
                returns=record.returns[share],
                final_eval=record.final_eval[share],
                metrics_bytes=log.flush(),
                ends=[end for s, end in ends.items() if share.start <= s < share.stop],
            )
            own = state
            if len(self.logs) > 1:  # of which the configuration has the numbers
                own = jax.tree.map(lambda leaf, at=share: leaf[at], state.replace(numbers={}))
            store.save(own, part, mine)

    def restore(self) -> tuple[Any, Gathered, Record, dict[int, End], list[str]]:
        """(state [S, ...], metrics since the last row, record, ends by learner, notes).

        All from the newest sound checkpoints of one step; a kill may have left others.
        """
        got = [store.restore() for store in self.stores]
        step = min(record.step for _, _, record, _ in got)
        for k, store in enumerate(self.stores):
            if got[k][2].step > step:
                got[k] = store.restore(step)
        states, gathered, records, notes = zip(*got, strict=True)
        ends: dict[int, End] = {}
        for record, share in zip(records, self.shares(), strict=True):
            seeds = self.loop.seeds[share]
            ends |= {share.start + seeds.index(end["seed"]): end for end in record.ends}
        lines = [line for own in notes for line in own]
        for log, record in zip(self.logs, records, strict=True):
            lines += log.rewind(record.metrics_bytes, step)
        whole = replace(
            records[0],
            returns=[pairs for record in records for pairs in record.returns],
            final_eval=[value for record in records for value in record.final_eval],
            wall_s=max(record.wall_s for record in records),
            unevaluated=any(record.unevaluated for record in records),
            ends=[],
        )
        state = states[0]
        if len(states) > 1:
            state = concatenated(states).replace(numbers=self.loop.numbers)
            state = self.loop.on_devices(state)
        return state, Gathered.joined(gathered), whole, ends, lines

    def learner(self, number: int) -> Any:
        """AgentState [...] of one learner in the newest checkpoint, or else its first one."""
        k, i = divmod(number, len(self.loop.seeds) // len(self.logs))
        numbers = {path: values[number] for path, values in self.loop.numbers.items()}
        return self.stores[k].learner(i).replace(numbers=numbers)
