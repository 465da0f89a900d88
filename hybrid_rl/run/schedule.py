"""What happens when, in decisions of each learner."""

from collections.abc import Collection
from dataclasses import dataclass


@dataclass(frozen=True)
class Schedule:
    """The length of a run, and its multiples at which it logs, evaluates and saves."""

    total_steps: int
    log_every: int
    eval_every: int
    eval_episodes: int
    eval_modes: tuple[str, ...]
    checkpoint_every: int
    checkpoint_replay: bool

    @property
    def _marks(self) -> tuple[int, ...]:
        return self.log_every, self.eval_every, self.checkpoint_every

    def until(self, step: int, changes: Collection[int]) -> int:
        """Where a call of the program that begins at `step` has to end.

        changes: the steps at which a decision begins to take another time.
        """
        marks = ((step // every + 1) * every for every in self._marks)
        return min(self.total_steps, *marks, *(change for change in changes if change > step))

    def due(self, every: int, step: int, worlds: int) -> bool:
        """Whether a multiple of `every`, or the end, lies in the round that ended at `step`."""
        return step // every > (step - worlds) // every or step >= self.total_steps

    def row_due(self, step: int, worlds: int) -> bool:
        """Whether a row of means ends at `step`."""
        return any(self.due(every, step, worlds) for every in self._marks)
