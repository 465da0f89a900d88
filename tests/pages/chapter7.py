"""docs/results/chapter7.md."""

from typing import Any

import numpy as np

from pages import chapter7_embedding, chapter7_falls, chapter7_tracking
from pages.cited import Table, Text
from pages.values import read

PAGE = "docs/results/chapter7.md"
CONTROL = read("fig_7_1")
INSIDE = CONTROL["by_data"]["2.5, starts 2"]


def middle(values: list[float]) -> list[float]:
    """Median, lowest and highest of the draws."""
    return [float(np.median(values)), min(values), max(values)]


def ratio(one: dict[str, Any], column: str) -> list[float]:
    """A cell of the tables of figure 7-1."""
    if column == "optimum, cost":
        return [one["optimum"]]
    if column.startswith("less error"):
        return [float(np.median(one["Koopman"]["less_error"]))]
    name, measure = column.split(", ")
    return middle(one[name][measure])


def by_data(label: str, column: str) -> list[float]:
    """A row by samples and starts, at the longest horizon."""
    return ratio(CONTROL["by_data"][label.replace(", ", ", starts ")]["400"], column)


def rates(label: str, column: str) -> list[float]:
    """Eigenvalues of A in the first draw, the pair once."""
    one = next(each for name, each in CONTROL["rates_of_A"].items() if name.startswith(f"{label},"))
    parts = list(zip(one["real"][0], one["imaginary"][0], strict=True))
    (pair,) = [each for each in parts if each[1] > 0]
    slow, fast = sorted((real for real, imaginary in parts if not imaginary), key=abs)
    cells = {"complex pair, real": pair[0], "imaginary": pair[1], "slow": slow, "fast": fast}
    return [cells[column]]


def clipped() -> float:
    """[%] of the actions of the regulator that clips most."""
    each = [one["clipped"] for data in CONTROL["by_data"].values() for one in data.values()]
    return 100 * float(np.max(each))


def furthest() -> float:
    """[%] between the regression's cost and the known system's, at most."""
    ratios = [np.array(one["regression"]["cost"]) for one in INSIDE.values()]
    return 100 * float(np.abs(np.concatenate(ratios) - 1).max())


LONGEST = INSIDE["400"]
KOOPMAN = float(np.median(LONGEST["Koopman"]["cost"]))
SLOW = [
    rate
    for reals, imaginaries in zip(*CONTROL["rates_of_A"]["2.5, starts 2"].values(), strict=True)
    for rate in [max(r for r, i in zip(reals, imaginaries, strict=True) if not i)]
]
COLUMNS = "Koopman, cost | optimum, cost | Koopman, error | less error in, of 50 starts"
CITED = [
    *chapter7_falls.CITED,
    *chapter7_embedding.CITED,
    *chapter7_tracking.CITED,
    Table(
        f"T [decisions] | {COLUMNS} | regression, cost | regression, error",
        lambda label, column: ratio(INSIDE[label], column),
    ),
    Table(f"samples within, starts within | {COLUMNS} | regression, cost", by_data),
    Table("samples within | complex pair, real | imaginary | slow | fast", rates),
    Text("At most #% of a regulator's actions", [clipped()]),
    Text(
        "itself costs # at T = 50 and # at T = 400; the optimum is #",
        [
            INSIDE["50"]["cost_of_known"],
            LONGEST["cost_of_known"],
            LONGEST["optimum"] * LONGEST["cost_of_known"],
        ],
    ),
    Text(
        "regulator is #% above the optimum, and only #% was",
        [100 * (KOOPMAN / LONGEST["optimum"] - 1), 100 * (1 - LONGEST["optimum"])],
    ),
    Text("a cost within #% at every horizon", [furthest()]),
    Text("it is between # and # over the draws", [min(SLOW), max(SLOW)]),
]
PLAIN = [
    *chapter7_falls.PLAIN,
    *chapter7_embedding.PLAIN,
    *chapter7_tracking.PLAIN,
    "jax 0.10",
    "(Q = I, R = 0.1)",
    "5,000 uniform samples",
    "10 draws of the samples (seeds 0 to 9), each with the same 50 starts, 10 s",
    "0.01 s (the author's code), samples within 2.5 and |u| up to 5, starts within 2",
    "(claim 1)",
    "(claim 2)",
    "at T = 50 and",
    "at T = 400; the",
    "At T = 400 the",
    "At T = 400:",
    "within 1 or 4 and starts within 2",
    "dt [1/s]",
    "0.5 +- 0.87i",
    "that of x1^2",
    "draws within 2.5",
]
