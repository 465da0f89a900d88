"""From the metrics of decisions to rows of metrics.jsonl.

`metrics` are arrays [rounds, S], `episode/...` [rounds, S, E]; a round is one decision in each
of E worlds of each of S learners. Rows have the number of a learner here, and its seed in a file.
"""

from collections.abc import Container, Mapping, Sequence
from typing import Self

import numpy as np

from hybrid_rl.run.logs.records import Row

Metrics = dict[str, np.ndarray]
ACTION = "world/action"


class Gathered:
    """The metrics since the last row of means; added in parts and averaged together."""

    def __init__(self) -> None:
        self._parts: list[Metrics] = []

    def add(self, metrics: Metrics) -> None:
        """Append the metrics of the next rounds; `episode/...` is left out."""
        selected = {name: m for name, m in metrics.items() if not name.startswith("episode/")}
        self._parts.append(selected)

    def whole(self) -> Metrics:
        """All of it [rounds, S]; {} if nothing was added."""
        if len(self._parts) > 1:
            names = self._parts[0]
            self._parts = [{n: np.concatenate([part[n] for part in self._parts]) for n in names}]
        return self._parts[0] if self._parts else {}

    def take(self) -> Metrics:
        """Return and remove all of it [rounds, S]."""
        whole, self._parts = self.whole(), []
        return whole

    def pack(self) -> tuple[list[str], np.ndarray | None]:
        """Names [M] and one array [M, rounds, S], for a checkpoint; None if there are none."""
        if not (whole := self.whole()):
            return [], None
        return list(whole), np.stack([np.asarray(m, np.float32) for m in whole.values()])

    def unpack(self, names: list[str], array: np.ndarray) -> None:
        """Restore what `pack` returned."""
        self._parts = [dict(zip(names, np.asarray(array), strict=True))]

    def split(self, count: int) -> "list[Gathered]":
        """`count` of them, each with as many learners; all are kept here, too."""
        if count == 1:
            return [self]
        each = [Gathered() for _ in range(count)]
        cut = {name: np.split(m, count, axis=1) for name, m in self.whole().items()}
        for i, one in enumerate(each if cut else ()):
            one.add({name: shares[i] for name, shares in cut.items()})
        return each

    @classmethod
    def joined(cls, each: "Sequence[Gathered]") -> Self:
        """The inverse of `split`."""
        made, wholes = cls(), [one.whole() for one in each]
        if all(wholes):
            made.add({n: np.concatenate([w[n] for w in wholes], axis=1) for n in wholes[0]})
        return made


def infinite(metrics: Metrics, start: int, worlds: int) -> dict[int, tuple[int, str]]:
    """Learner -> (step, name) of its earliest infinite entry; the metrics begin after `start`.

    Numbers of the world come first, and only where its action was finite: what learns from them is
    infinite at the same step.
    """
    first: dict[int, tuple[int, str]] = {}
    given = np.isfinite(metrics[ACTION]) if ACTION in metrics else np.True_
    for name in sorted(metrics, key=lambda name: not of_world(name)):
        if name.startswith("episode/"):
            continue
        bad = np.isinf(metrics[name])
        for i, s in np.argwhere(bad & given if of_world(name) else bad):
            step = start + (int(i) + 1) * worlds
            if s not in first or step < first[s][0]:
                first[int(s)] = step, name
    return first


def of_world(name: str) -> bool:
    """True if a metric is a number that a world returns."""
    return name.startswith("world/") and name != ACTION


def episodes(metrics: Metrics, start: int, worlds: int, ended: Mapping[int, int]) -> list[Row]:
    """A row per episode that ended in the rounds after `start`.

    ended: learner -> the step at which it diverged; it has no rows from there on.
    """
    return [
        {
            "step": step,
            "learner": int(s),
            "train/return": metrics["episode/return"][i, s, e],
            "train/length": int(metrics["episode/length"][i, s, e]),
        }
        for i, s, e in np.argwhere(metrics["episode/done"])
        if (step := start + (int(i) + 1) * worlds) < ended.get(int(s), np.inf)
    ]


def means(metrics: Metrics, learners: int, end: int, ended: Container[int] = ()) -> list[Row]:
    """A row of means per learner; NaN is left out, and a name with nothing else.

    ended: learners that diverged, which have no row.
    """
    averages = []
    for s in range(learners):
        if s in ended:
            continue
        row: Row = {"step": end, "learner": s}
        for name, values in metrics.items():
            known = values[:, s][~np.isnan(values[:, s])]
            if known.size:
                row[name] = known.mean(dtype=np.float64)
        averages.append(row)
    return averages
