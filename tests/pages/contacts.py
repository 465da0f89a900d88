"""Numbers of contact maps and poses, for docs/results/chapter5.md."""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.stats import binomtest

from hybrid_rl.analysis.curves import band, iqm
from pages.values import read

MAPS, POSES = "fig_5_5_mapping", "fig_5_5_localisation"
SEVENTH, ROWS = "fig_5_7", "fig_5_2_rows"
FIRST = "Fourier trace"
ALONE = {  # row -> its own file
    "informative paths": "fig_5_5_informative",
    "Fourier, 0.1 instead of 0.02": "fig_5_6_wrong",
    "MuJoCo, map made in MuJoCo": "sprk_57_own",
    "MuJoCo, map of the formula": "sprk_57",
    "map made in MuJoCo": "sprk_57",
}
ARRANGEMENTS = ("first", "second", "third")
LEARNED = {  # row -> file and its label
    "learned map, default: trace": ("fig_5_4_learned", "trace"),
    "learned map, chosen": ("fig_5_4_learned", "mutual, 3,000 particles"),
    "second learned map, chosen": ("fig_5_4_learned", "mutual, 3,000 particles, second map"),
    "third learned map, chosen": ("fig_5_4_learned", "mutual, 3,000 particles, third map"),
    "learned map, coverage, default": ("fig_5_4_learned", "coverage"),
    "learned map, entropy, default": ("fig_5_4_learned", "entropy"),
    "2% wrong, known map, default: trace": ("fig_5_4_wrong", "known map, trace"),
    "2% wrong, known map, mutual": ("fig_5_4_wrong", "known map, mutual"),
    "2% wrong, known map, coverage": ("fig_5_4_wrong", "known map, coverage"),
    "2% wrong, known map, entropy": ("fig_5_4_wrong", "known map, entropy"),
    "2% wrong, known map, manifold filter": ("fig_5_4_wrong", "known map, manifold filter"),
    "2% wrong, learned map, chosen": ("fig_5_4_wrong", "learned map, mutual, 3,000 particles"),
    "2% wrong, second learned map, chosen": ("fig_5_4_wrong", "second learned map"),
    "2% wrong, third learned map, chosen": ("fig_5_4_wrong", "third learned map"),
    "2% wrong, learned map, coverage, chosen": ("fig_5_4_wrong", "learned map, coverage"),
}


def one(file: str, label: str) -> dict[str, Any]:
    """The numbers of one run."""
    return read(file)["methods"][label]


def interval(each: list[float]) -> list[float]:
    """IQM, low and high of one number of each trial."""
    values = np.array(each)[:, None]
    low, high = band(values)
    return [float(iqm(values)[0]), float(low[0]), float(high[0])]


def at(file: str, seconds: float) -> int:
    """The index of a time."""
    return int(np.argmin(np.abs(np.array(read(file)["times"]) - seconds)))


def touched(file: str, label: str, seconds: float) -> list[float]:
    """Trials that touched every object, and all trials."""
    each = np.array(one(file, label)["objects"]["each"])
    return [int((each[:, at(file, seconds)] == MOST[file]).sum()), len(each)]


MOST = {MAPS: 3, ROWS: 3, "fig_5_6": 3, "fig_5_6_wrong": 3, "sprk": 3}


def over_time(file: str, label: str, name: str, seconds: float) -> list[float]:
    """IQM, low and high of a measure at a time."""
    measure, i = one(file, label)[name], at(file, seconds)
    return [measure[part][i] for part in ("iqm", "low", "high")]


def mapped(file: str, end: float) -> Callable[[str, str], list[float]]:
    """Cells of a table of maps."""

    def values(label: str, column: str) -> list[float]:
        early = 20.0 if "20 s" in column else 60.0
        if column.startswith("all 3"):
            return touched(file, label, early)
        if "objects touched" in column:
            each = np.array(one(file, label)["objects"]["each"])
            return [float(iqm(each)[at(file, end)])]
        if "mean IoU" in column:
            return interval(one(file, label)["mean_iou"]["each"])
        if "seconds until" in column:
            return [one(file, label)["seconds_to_all"]["median"]]
        name = "iou" if "IoU" in column else "outline" if "outline" in column else "cells"
        return over_time(file, label, name, early if "at 20 s" in column else end)

    return values


def sixth(label: str, column: str) -> list[float]:
    """Cells of figure 5-6's table."""
    file = "sprk" if label.startswith("MuJoCo") else ALONE.get(label, "fig_5_6")
    label = label.removeprefix("MuJoCo, ")
    names = {"rejected": "rejected", "return": "returned", "elsewhere": "elsewhere"}
    if column == "false contacts a trial":
        return interval(one(file, label)["false"]["count"]["each"])
    if column in names:
        return interval(one(file, label)["false"][names[column]]["each"])
    return mapped(file, 120.0)(label, column)


def found(file: str, label: str, column: str, early: float, end: float) -> list[float]:
    """A cell of a table of poses."""
    numbers = one(file, label)
    if "position" in column or "angle" in column:
        each = numbers["each"]["position" if "position" in column else "angle"]
        return [float(np.median(np.array(each)[:, at(file, end)]))]
    if "never" in column:
        return [sum(wait is None for wait in numbers["found"]["each"])]
    if "stuck" in column:
        return [sum(numbers["each"]["stuck"])]
    if "seconds" in column:
        return [float(np.median(waits(file, label)))]
    if column.startswith("p "):
        return [sooner(waits(file, label), waits(POSES, FIRST))[-1]]
    seconds = early if f"{early:g} s" in column else end
    position, angle = (
        np.array(numbers["each"][name])[:, at(file, seconds)] for name in ("position", "angle")
    )
    return [int(((position < 0.03) & (angle < 0.1)).sum())]


def waits(file: str, label: str) -> np.ndarray:
    """[S] seconds until found; infinite if never."""
    each = one(file, label)["found"]["each"]
    return np.array([np.inf if wait is None else wait for wait in each])


def sooner(a: np.ndarray, b: np.ndarray) -> list[float]:
    """Trials in which a is smaller, and p of the sign test."""
    less, more = int((a < b).sum()), int((a > b).sum())
    return [less, float(binomtest(less, less + more).pvalue)]


def poses(file: str, early: float, end: float) -> Callable[[str, str], list[float]]:
    """Cells of a table of poses, of one file or the row's own."""
    return lambda label, column: found(ALONE.get(label, file), label, column, early, end)


def learned(label: str, column: str) -> list[float]:
    """Cells of the table of learned maps and wrong readings."""
    return found(*LEARNED[label], column, 20.0, 40.0)


def seventh(label: str, column: str) -> list[float]:
    """Cells of figure 5-7's table."""
    return poses(SEVENTH, 40.0, 130.0)(label, column)


def entropy(label: str, column: str) -> list[float]:
    """Cells of the table of entropies."""
    seconds = 10 if "10 s" in column else 40  # a column of the file for each second
    return interval([row[seconds - 1] for row in read("absence")["kinds"][label]["each"]])


def arranged(label: str, column: str) -> list[float]:
    """Cells of the table of arrangements."""
    return interval(one(f"arrangement_{column}", label)["mean_iou"]["each"])


def good(file: str, label: str) -> float:
    """Trials within 3 cm and 0.1 rad at 40 s."""
    return poses(file, 20.0, 40.0)(label, "at 40 s")[0]


def median_iou(label: str) -> float:
    """Of figure 5-2 at 60 s."""
    return one(MAPS, label)["iou"]["median"][-1]
