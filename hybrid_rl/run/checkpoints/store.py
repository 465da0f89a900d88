"""The checkpoints of a run: the learners' state, and its record."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.core.batching import join
from hybrid_rl.errors import MisfitError
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.logs.log import RunLog
from hybrid_rl.run.logs.records import Row, Sums
from hybrid_rl.run.schedule import Speed
from hybrid_rl.training.agent import Agent, AgentState
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
    sums: Sums = field(default_factory=dict)  # of metrics since the last row of means
    metrics_bytes: int = 0  # of a checkpoint: the size of metrics.jsonl then
    learning: Speed = field(default_factory=Speed)  # over all sessions
    unevaluated: bool = False  # an evaluation is due at `step`
    ends: dict[int, End] = field(default_factory=dict)  # of learners that diverged, by number


def read_parts(
    folder: Path, agent: Agent, seeds: Sequence[int], parts: Sequence[str], step: int | None = None
) -> tuple[int, AgentState, dict[str, Any], list[str]]:
    """(step, state [S, ...], meta, notes) of the newest sound checkpoint, or the one at `step`.

    parts: the fields of the state that are read; the others are None. The memory has the capacity
    that it had there. MisfitError for the learners of other seeds.
    """

    def like(meta: dict[str, Any]) -> Any:
        if meta["seeds"] != [*seeds]:
            has, wanted = (", ".join(map(str, each)) for each in (meta["seeds"], seeds))
            raise MisfitError(f"{folder} holds the learners of seed {has}, not of seed {wanted}")
        sized = replace(agent, replay=replace(agent.replay, capacity=meta["capacity"]))
        shapes = Loop(sized, tuple(seeds), 1).shapes()
        others = {field.name: None for field in fields(shapes) if field.name not in parts}
        return shapes.replace(**others)

    return checkpoint.restore(folder, like, step)


def each_learner(change: Callable[[Any], Any], memory: Any) -> Any:
    """The results [S, ...] of `change` for the memory of each learner."""
    learners = range(len(memory.count))
    each = [change(jax.tree.map(lambda leaf, s=s: leaf[s], memory)) for s in learners]
    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *each)


@dataclass
class Shelf:
    """The records and checkpoints of a program: of its run or, with an axis, of each of K runs.

    Each of the K folders has the rows and the checkpoints of its n learners, as if they were alone;
    `loop` trains all S = K n. An OnlineLearner has no logs.
    """

    loop: Loop
    folders: Sequence[Path]  # [K] of checkpoints
    settings: Sequence[Mapping[str, Any]]  # [K] config.yaml by full keys, which checkpoints repeat
    logs: Sequence[RunLog] = ()  # [K]
    replay: bool = True  # whether checkpoints hold the replay memory
    newest: int | None = None  # step of the checkpoints that were written or read last

    def shares(self) -> list[slice]:
        """The learners of each folder."""
        size = len(self.loop.seeds) // len(self.folders)
        return [slice(k * size, (k + 1) * size) for k in range(len(self.folders))]

    def write(self, new: Sequence[Row], wall_s: float) -> None:
        """Append rows {"step", "learner", name: number or word, ...}, with the wall time [s]."""
        for log, share in zip(self.logs, self.shares(), strict=True):
            for row in (row.copy() for row in new if share.start <= row["learner"] < share.stop):
                seed = self.loop.seeds[row.pop("learner")]
                log.write([{"step": row.pop("step"), "seed": seed} | row | {"wall_s": wall_s}])

    def save(self, state: Any, record: Record) -> None:
        """Write a checkpoint to each folder. state: [S, ...]."""
        sizes = [log.flush() for log in self.logs] or [0]
        each = zip(self.folders, self.settings, self.shares(), sizes, strict=True)
        for folder, settings, share, size in each:
            mine = replace(
                record,
                returns=record.returns[share],
                final_eval=record.final_eval[share],
                sums={name: values[:, share].tolist() for name, values in record.sums.items()},
                metrics_bytes=size,
            )
            ends = [end for s, end in record.ends.items() if share.start <= s < share.stop]
            own = state.replace(numbers={})  # which the configuration has
            own = own if self.replay else own.replace(memory=None)
            own = jax.tree.map(lambda leaf, at=share: leaf[at], own)  # of all, no copy
            meta = {
                "seeds": list(self.loop.seeds[share]),
                "capacity": self.loop.agent.replay.capacity,
                "settings": dict(settings),
                "record": asdict(mine) | {"ends": ends},
            }
            checkpoint.save(folder, record.step, own, meta)
        self.newest = record.step

    def restore(self) -> tuple[Any, Record, list[str]]:
        """(state [S, ...], record, notes).

        All from the newest sound checkpoints of one step; a kill may have left others.
        """
        state, metas, notes = self._state(None)
        records, ends = [], {}
        for meta, share in zip(metas, self.shares(), strict=True):
            seeds, own = self.loop.seeds[share], meta["record"]
            ends |= {share.start + seeds.index(end["seed"]): end for end in own.get("ends", ())}
            records.append(Record(**(own | {"ends": {}})))
        for log, record in zip(self.logs, records, strict=bool(self.logs)):
            notes += log.rewind(record.metrics_bytes, record.step)
        whole = replace(
            records[0],
            returns=[pairs for record in records for pairs in record.returns],
            final_eval=[value for record in records for value in record.final_eval],
            wall_s=max(record.wall_s for record in records),
            sums={
                name: np.concatenate([record.sums[name] for record in records], axis=1)
                for name in records[0].sums
            },
            unevaluated=any(record.unevaluated for record in records),
            learning=Speed(**metas[0]["record"]["learning"]),
            ends=ends,
        )
        return self.loop.on_devices(state), whole, notes

    def learner(self, number: int) -> Any:
        """AgentState [...] of one learner in the newest checkpoint, or else its first one."""
        state = self.loop.init() if self.newest is None else self._state(self.newest)[0]
        return jax.tree.map(lambda leaf: leaf[number], state)

    def _state(self, step: int | None) -> tuple[Any, list[dict[str, Any]], list[str]]:
        """(state [S, ...], meta of each folder, notes) of a step; None: the newest of all folders.

        The memory is empty if checkpoints hold none.
        """
        parts = [each.name for each in fields(AgentState) if each.name != "memory" or self.replay]
        agent, seeds = self.loop.agent, self.loop.seeds[self.shares()[0]]
        read = [read_parts(folder, agent, seeds, parts, step) for folder in self.folders]
        self.newest = min(reached for reached, *_ in read)
        for k, folder in enumerate(self.folders):
            if read[k][0] > self.newest:
                read[k] = read_parts(folder, agent, seeds, parts, self.newest)
        _, states, metas, notes = zip(*read, strict=True)
        state, now = join(*states).replace(numbers=self.loop.numbers), self.loop.agent.replay
        if not self.replay:
            state = state.replace(memory=self.loop.init().memory)
        elif metas[0]["capacity"] != now.capacity:  # a run that is extended may have a larger one
            state = state.replace(memory=each_learner(now.resized, state.memory))
        return state, [*metas], [line for own in notes for line in own]
