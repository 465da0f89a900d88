"""Figures 6-9 and 6-10 in docs/results/chapter6.md."""

from typing import Any

import numpy as np

from pages.values import read

LITERAL = "kle3_imitation, gain 10000, variance 0.01"
ROWS = {  # label of the page -> label of the JSON
    "KL-E3": "kle3_imitation",
    "KL-E3, no spacing": "kle3_imitation, no spacing",
    "KL-E3, p(s) by the gain": "kle3_imitation, p by gain",
    "KL-E3, guarded at V = 10": "kle3_imitation, V below 10",
    "KL-E3, guarded at V = 2": "kle3_imitation, V below 2",
    "KL-E3, literal": f"{LITERAL}, no spacing",
    "KL-E3, literal, guarded at V = 20": f"{LITERAL}, V below 20, no spacing",
    "KL-E3, literal, guarded at V = 2": f"{LITERAL}, V below 2, no spacing",
    "MINIE": "minie",
    "MINIE as printed": "minie, no spacing",
    "NIE": "nie",
    "NIE as printed": "nie, no spacing",
    "NIE, half the noise": "nie, noise 0.5",
    "starts of the flip": "starts of the flip",
}
EVERY = read("fig_6_9")["rows"] | read("fig_6_9_more")["rows"]
INFORMATION = read("fig_6_10")["rows"]
LOST = read("fig_6_9")["lost_from_V"]
SAFETY = {
    "V, median": "greatest_V_median",
    "V, greatest": "greatest_V",
    "beyond 90 degrees [%]": "beyond_90_degrees",
    "abs(z) above 1 [%]": "higher_or_lower_than_1",
}


def percent(label: str, most: int, criterion: str = "success", length: int = 15_000) -> list[float]:
    """IQM, low and high of the shares of one row [%]."""
    one = EVERY[ROWS[label]][f"{most}"][criterion][f"{length}"]
    return [100 * one[name] for name in ("iqm", "low", "high")]


def succeeded(label: str, column: str) -> list[float]:
    """A cell such as "10" or "10, 3,000 steps"."""
    most, _, short = column.partition(", ")
    return percent(label, int(most), "success", 3_000 if short else 15_000)


def turned(label: str, column: str) -> list[float]:
    """A cell such as "10 turned"."""
    return percent(label, int(column.partition(" ")[0]), "turned")


def safe(label: str, column: str) -> list[float]:
    """A cell of the table of safety, of the runs with 20 queries."""
    one = EVERY[ROWS[label]]["20"]["safety"]
    if column == "deviation of x, z, th":
        return one["std"][:3]
    value = one[SAFETY[column]]
    return [100 * value if "%" in column else value]


def informed(label: str, column: str) -> list[float]:
    """A cell such as "own, 5": IQM, low and high of tr I at a query."""
    kind, query = column.split(", ")
    one = INFORMATION[ROWS[label]][kind]
    return [one[name][int(query) - 1] for name in ("iqm", "low", "high")]


def asked(label: str) -> float:
    """Mean number of queries in the run of at most 20."""
    return float(np.mean(EVERY[ROWS[label]]["20"]["asked"]))


def ahead(pair: str) -> list[float]:
    """[%] of pairs of seeds in which the first row is better, and its band."""
    return [100 * part for part in read("fig_6_9")["comparisons"][pair]]


def apart(kind: str) -> Any:
    """The first query from which the bands of KL-E3 are above those of MINIE."""
    ours, others = (INFORMATION[name][kind] for name in ("kle3_imitation", "minie"))
    above = [a > b for a, b in zip(ours["low"], others["high"], strict=False)]
    return 1 + next(i for i in range(len(above)) if all(above[i:]))
