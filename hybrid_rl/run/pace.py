"""How long a call of a compiled program may take, and how fast it goes."""

from dataclasses import dataclass

CALL = 1.5  # [s] that a call takes, about: nothing on the host can happen meanwhile
GROWTH = 4.0  # of the number of rounds from one call to the next, at most


@dataclass
class Pace:
    """The number of rounds of the next call, from how long the last one took.

    It starts with one round. After a change in what a round computes, start with a new Pace.
    """

    most: float = 1.0  # rounds

    def rounds(self, left: int) -> int:
        """Rounds of the next call, of `left`."""
        return min(left, int(self.most))

    def took(self, rounds: int, seconds: float) -> None:
        """Learn from a call of `rounds` that took `seconds`."""
        fitting = rounds * CALL / max(seconds, 1e-9)
        self.most = max(1.0, min(GROWTH * self.most, fitting))


@dataclass
class Speed:
    """Decisions and the seconds that they took."""

    decisions: int = 0
    seconds: float = 0.0

    def add(self, decisions: int, seconds: float) -> None:
        """Count a call in."""
        self.decisions += decisions
        self.seconds += seconds

    @property
    def rate(self) -> float | None:
        """[1/s]; None before anything was counted."""
        return self.decisions / self.seconds if self.seconds else None
