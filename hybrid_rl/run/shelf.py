"""The folders of a program: that of a run or, with an axis, a run folder for each set of numbers.

Each of K folders has the rows and the checkpoints of its n learners, as if they were alone.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import jax

from hybrid_rl.run.checkpoints.store import End, Record, Store
from hybrid_rl.run.logs.log import RunLog
from hybrid_rl.run.logs.records import Row
from hybrid_rl.run.logs.rows import Gathered
from hybrid_rl.run.start import concatenated
from hybrid_rl.training.loop import Loop


@dataclass
class Shelf:
    """Writes what the S = K n learners of `loop` do; logs and stores: [K]."""

    loop: Loop
    logs: Sequence[RunLog]
    stores: Sequence[Store]

    @property
    def newest(self) -> int | None:
        """The step of the checkpoint that was written or read last."""
        return self.stores[-1].newest

    def shares(self) -> list[slice]:
        """The learners of each folder."""
        each = len(self.loop.seeds) // len(self.logs)
        return [slice(k * each, (k + 1) * each) for k in range(len(self.logs))]

    def write(self, new: Sequence[Row], wall_s: float) -> None:
        """Append rows {"step", "learner", name: number or word, ...}, with the wall time [s]."""
        for log, share in zip(self.logs, self.shares(), strict=True):
            mine = [row for row in new if share.start <= row["learner"] < share.stop]
            log.write([self._written(row) | {"wall_s": wall_s} for row in mine])

    def _written(self, row: Row) -> Row:
        """A row with the seed of its learner."""
        named = {"step": row["step"], "seed": self.loop.seeds[row["learner"]]}
        return named | {name: value for name, value in row.items() if name != "learner"}

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
            store.save(self._share(state, share), part, mine)

    def restore(self) -> tuple[Any, Gathered, Record, dict[int, End], list[str]]:
        """(state [S, ...], metrics since the last row, record, ends by learner, notes).

        All from the newest sound checkpoints of one step; a kill may have left others.

        Raises:
            CheckpointError: if there is none, or it belongs to another run.
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
        lines = [line for each in notes for line in each]
        for log, record in zip(self.logs, records, strict=True):
            lines += log.rewind(record.metrics_bytes, step)
        whole = replace(
            records[0],
            returns=[each for record in records for each in record.returns],
            final_eval=[each for record in records for each in record.final_eval],
            wall_s=max(record.wall_s for record in records),
            unevaluated=any(record.unevaluated for record in records),
            ends=[],
        )
        return self._whole(states), Gathered.joined(gathered), whole, ends, lines

    def learner(self, number: int) -> Any:
        """AgentState [...] of one learner in the newest checkpoint, or else its first one."""
        k, i = divmod(number, len(self.loop.seeds) // len(self.logs))
        numbers = {path: each[number] for path, each in self.loop.numbers.items()}
        return self.stores[k].learner(i).replace(numbers=numbers)

    def _share(self, state: Any, share: slice) -> Any:
        """The state [n, ...] of the learners of a folder, whose configuration has their numbers."""
        if len(self.logs) == 1:
            return state
        return jax.tree.map(lambda leaf: leaf[share], state.replace(numbers={}))

    def _whole(self, states: Sequence[Any]) -> Any:
        """The state [S, ...] of those of all folders."""
        if len(states) == 1:
            return states[0]
        return self.loop.on_devices(concatenated(states).replace(numbers=self.loop.numbers))
