"""Speeds measured side by side: every round runs each contestant once.

A machine that is now fast, now slow is so to all of a round equally; what is compared is the ratio
within a round, and its median over rounds.
"""

import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any


@dataclass(frozen=True)
class Contestant:
    """Something that does `work` units each time it is called."""

    name: str
    go: Callable[[], Any]  # returns when its work is done
    work: float
    memory: float | None = None  # [bytes] that each of its learners takes, where known


def race(contestants: Sequence[Contestant], rounds: int) -> list[dict[str, Any]]:
    """A row each: median and best rate [work/s], and the ratio to the first contestant.

    Each is called once before, to warm up.
    """
    for contestant in contestants:
        contestant.go()
    seconds: list[list[float]] = [[] for _ in contestants]
    for _ in range(rounds):
        for contestant, times in zip(contestants, seconds, strict=True):
            began = perf_counter()
            contestant.go()
            times.append(perf_counter() - began)
    rates = [
        [contestant.work / time for time in times]
        for contestant, times in zip(contestants, seconds, strict=True)
    ]
    return [
        {
            "name": contestant.name,
            "rate": statistics.median(own),
            "best": max(own),
            "ratio": statistics.median(a / b for a, b in zip(own, rates[0], strict=True)),
            "memory": contestant.memory,
        }
        for contestant, own in zip(contestants, rates, strict=True)
    ]
