"""From the metrics of decisions to rows of metrics.jsonl.

`metrics` are arrays [rounds, S], `episode/...` [rounds, S, E]; a round is one decision in each
of E worlds of each of S learners. Rows have the number of a learner here, and its seed in a file.
"""

from collections.abc import Container, Mapping, Sequence
from typing import Self

import numpy as np

from hybrid_rl.run.records import Row

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

    def take(self) -> Metrics:
        """Return and remove all of it [rounds, S]."""
        parts, self._parts = self._parts, []
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def pack(self) -> tuple[list[str], np.ndarray | None]:
        """Names [M] and one array [M, rounds, S], for a checkpoint; None if there are none."""
        if not self._parts:
            return [], None
        whole = self.take()
        self._parts = [whole]
        return list(whole), np.stack([np.asarray(m, np.float32) for m in whole.values()])

    def unpack(self, names: list[str], array: np.ndarray) -> None:
        """Restore what `pack` returned."""
        self._parts = [dict(zip(names, np.asarray(array), strict=True))]

    def split(self, count: int) -> "list[Gathered]":
        """`count` of them, each with as many learners; all are kept here, too."""
        if count == 1:
            return [self]
        each = [Gathered() for _ in range(count)]
        if self._parts:
            whole = self.take()
            self._parts = [whole]
            cut = {name: np.split(m, count, axis=1) for name, m in whole.items()}
            for i, one in enumerate(each):
                one._parts = [{name: shares[i] for name, shares in cut.items()}]
        return each

    @classmethod
    def joined(cls, each: "Sequence[Gathered]") -> Self:
        """What was `split`."""
        made = cls()
        if all(one._parts for one in each):
            wholes = [one.take() for one in each]
            names = wholes[0]
            made._parts = [{n: np.concatenate([w[n] for w in wholes], axis=1) for n in names}]
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
    """Whether a metric is what a world returns."""
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
