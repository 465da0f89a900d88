"""Values that pages cite, recomputed from the JSON of docs/results, and tables made of them."""

import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from scipy.stats import mannwhitneyu

from hybrid_rl.analysis.curves import RESAMPLES, improvement, iqm
from pages.cited import NUMBER, ROOT, Table

RESULTS = ROOT / "docs" / "results"


@cache
def read(name: str) -> Any:
    """docs/results/NAME.json."""
    return json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class Curve:
    """One line of a figure, from its JSON."""

    x: np.ndarray  # [G]
    each: np.ndarray  # [S, G]
    iqm: np.ndarray  # [G], low and high too: recomputed from `each`
    low: np.ndarray
    high: np.ndarray

    def at(self, x: float) -> list[float]:
        """IQM, low and high at x."""
        i = self.index(x)
        return [float(line[i]) for line in (self.iqm, self.low, self.high)]

    def index(self, x: float) -> int:
        """The index of x."""
        (indices,) = np.nonzero(self.x == x)
        assert len(indices) == 1, f"no evaluation at {x:,}: {self.x}"
        return int(indices[0])

    def seeds(self, x: float) -> np.ndarray:
        """[S] values of the seeds at x."""
        return self.each[:, self.index(x)]

    def area(self, end: float | None = None) -> np.ndarray:
        """[S] mean of each line up to `end`; the first value is taken to hold from 0 on."""
        included = self.x <= (self.x[-1] if end is None else end)
        x = np.append(0.0, self.x[included])
        y = np.concatenate([self.each[:, :1], self.each[:, included]], axis=1)
        return np.trapezoid(y, x, axis=1) / x[-1]


@cache
def curve(name: str, label: str, metric: str = "", task: str = "") -> Curve:
    """The one line of NAME.json of that label (and metric, and task, where there are several)."""
    (one,) = (
        line
        for line in read(name)["curves"]
        if line["label"] == label
        and metric in ("", line.get("metric", read(name)["metric"]))
        and task in ("", line["task"])
    )
    each = np.array(one["each"])
    return Curve(np.array(one["x"]), each, iqm(each), *band(each))


def parts(name: str) -> Callable[[str, str], list[float]]:
    """Cells of a table of NAME.json's lines: at a column's step, or there its lowest seed."""

    def cell(label: str, column: str) -> list[float]:
        one = curve(name, label)
        step = number(column.split(", ")[-1])
        return [float(one.seeds(step).min())] if "lowest" in column else one.at(step)

    return cell


def band(each: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """As `hybrid_rl.analysis.curves.band`, with all resamples in one array."""
    draws = np.random.default_rng(0).integers(len(each), size=(RESAMPLES, len(each)))
    low, high = np.percentile(iqm(each[draws.T]), [2.5, 97.5], axis=0)
    return low, high


def spread(each: np.ndarray) -> list[float]:
    """IQM, low and high of [S]."""
    return [float(iqm(each)), *(float(end) for end in band(each))]


def ahead(x: np.ndarray, y: np.ndarray) -> list[float]:
    """[%] of pairs in which x is greater, and its band."""
    return [100 * part for part in improvement(x, y)]


def p_value(x: np.ndarray, y: np.ndarray) -> float:
    """Mann-Whitney's, two-sided."""
    return float(mannwhitneyu(x, y).pvalue)


def significant(value: float, digits: int) -> float:
    """Rounded to so many digits."""
    return float(f"{value:.{digits - 1}e}")


def number(text: str) -> float:
    """The last number of a row's label."""
    return float(re.findall(NUMBER, text)[-1].replace(",", ""))


def returns(header: str, files: dict[str, str], columns: dict[str, str] | None = None) -> Table:
    """A table of returns: the file by the row's first words, x its last number.

    columns: header of a column to the curve's label, where they differ.
    """

    def values(label: str, column: str) -> list[float]:
        name = (columns or {}).get(column, column)
        return curve(file_of(label, files), name, "eval/return").at(number(label))

    return Table(header, values)


def file_of(label: str, files: dict[str, str]) -> str:
    """The file of the longest key that the label starts with."""
    return files[max((key for key in files if label.startswith(key)), key=len)]


def areas(header: str, files: dict[str, str], ours: str, after: str = "") -> Table:
    """A table of areas under the curve to the row's x; "ahead of B": `ours` against B."""

    def values(label: str, column: str) -> list[float]:
        def area(name: str) -> np.ndarray:
            return curve(file_of(label, files), name, "eval/return").area(number(label))

        against = column.removeprefix("ahead of ")
        return ahead(area(ours), area(against)) if against != column else spread(area(column))

    return Table(header, values, after)
