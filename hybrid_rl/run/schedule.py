"""The steps at which a run logs, evaluates and saves, and the length of calls between them."""

from collections.abc import Collection
from dataclasses import dataclass

CALL = 1.5  # [s] per call, about; the host waits meanwhile
GROWTH = 4.0  # greatest ratio of rounds from one call to the next


@dataclass(frozen=True)
class Schedule:
    """The length of a run, and its multiples at which it logs, evaluates and saves."""

    total_steps: int
    log_every: int
    eval_every: int
    eval_episodes: int
    checkpoint_every: int

    @property
    def _marks(self) -> tuple[int, ...]:
        return self.log_every, self.eval_every, self.checkpoint_every

    def until(self, step: int, changes: Collection[int]) -> int:
        """The step at which a call of the program that begins at `step` ends.

        changes: the steps at which the work per decision changes.
        """
        marks = ((step // every + 1) * every for every in self._marks)
        return min(self.total_steps, *marks, *(change for change in changes if change > step))

    def due(self, every: int, step: int, worlds: int) -> bool:
        """True if a multiple of `every`, or the end, lies in the round that ended at `step`."""
        return step // every > (step - worlds) // every or step >= self.total_steps

    def row_due(self, step: int, worlds: int) -> bool:
        """True if a row of means ends at `step`."""
        return any(self.due(every, step, worlds) for every in self._marks)


@dataclass
class Pace:
    """The number of rounds of the next call, from the duration of the last one.

    The first call has one round. Create a new Pace when the work per round changes.
    """

    most: float = 1.0  # rounds

    def rounds(self, left: int) -> int:
        """Rounds of the next call, of `left`."""
        return min(left, int(self.most))

    def took(self, rounds: int, seconds: float) -> None:
        """Adapt to a call of `rounds` that took `seconds`."""
        fitting = rounds * CALL / max(seconds, 1e-9)
        self.most = max(1.0, min(GROWTH * self.most, fitting))


@dataclass
class Speed:
    """Decisions and the seconds that they took."""

    decisions: int = 0
    seconds: float = 0.0

    def add(self, decisions: int, seconds: float) -> None:
        """Add a call."""
        self.decisions += decisions
        self.seconds += seconds

    @property
    def rate(self) -> float | None:
        """[1/s]; None before the first call."""
        return self.decisions / self.seconds if self.seconds else None
