"""Figures 6-9 and 6-10 in docs/results/chapter6.md."""

from typing import Any

import numpy as np

from pages.cited import Table, Text
from pages.values import read

LITERAL = "kle3_imitation, gain 10000, variance 0.01"
ROWS = {  # label of the page -> label of the JSON
    "KL-E3": "kle3_imitation",
    "KL-E3, no spacing": "kle3_imitation, no spacing",
    "KL-E3, p(s) by the gain": "kle3_imitation, p by gain",
    "KL-E3, guarded at V = 10": "kle3_imitation, V below 10",
    "KL-E3, guarded at V = 2": "kle3_imitation, V below 2",
    "KL-E3, literal": f"{LITERAL}, no spacing",
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


PAIRS = {10: "minie, no spacing > nie, no spacing, 10"}
CITED = [
    Table(
        "success [%] | 5 | 10 | 20 | 5, 3,000 steps | 10, 3,000 steps | 20, 3,000 steps", succeeded
    ),
    Table("upside down at some time [%] | 5 turned | 10 turned | 20 turned", turned),
    Table(
        "tr I at query | own, 2 | own, 5 | own, 10 | reference, 2 | reference, 5 | reference, 10",
        informed,
    ),
    Table(
        "exploration | V, median | V, greatest | beyond 90 degrees [%] | abs(z) above 1 [%] | "
        "deviation of x, z, th",
        safe,
    ),
    Text(
        "nearly. #% [#, #] with 15,000 steps, #% on average",
        [*percent("KL-E3", 5), 100 * EVERY["kle3_imitation"]["5"]["success"]["15000"]["mean"]],
    ),
    Text("with the looser criterion it is #%", percent("KL-E3", 5, "turned")[:1]),
    Text(
        "ahead in #% [#, #] of pairs of seeds at 5",
        ahead("kle3_imitation > starts of the flip, 5"),
    ),
    Text(
        "holds for NIE as printed (#%), which asks 20 times within 2 s, not for MINIE (#%)",
        [percent("NIE as printed", 20)[0], percent("MINIE as printed", 20)[0]],
    ),
    Text("(ahead in #% [#, #] of pairs at 10 queries", ahead(PAIRS[10])),
    Text("no difference (#% [#, #] at 10)", ahead("minie > nie, 10")),
    Text(
        "from query # on with its own clone and from query # on under the reference",
        [apart("own"), apart("reference")],
    ),
    Text("asks # of 20 queries in 100 s, MINIE #", [asked("KL-E3"), asked("MINIE")]),
    Text("KL-E3 with 5 of them reaches #%", percent("KL-E3, no spacing", 5)[:1]),
    Text(
        "from #% of the states at V = 3, #% at 10 and #% at 20, from all at 2",
        [100 * LOST[level] for level in ("3", "10", "20")],
    ),
    Text("The chosen row goes to V = # in", safe("KL-E3", "V, greatest")),
    Text(
        "at V = 2 reaches #% at 5 queries and #% at 10, with V up to #",
        [
            *(percent("KL-E3, guarded at V = 2", most)[0] for most in (5, 10)),
            *safe("KL-E3, guarded at V = 2", "V, greatest"),
        ],
    ),
    Text(
        "stays within V = # and still reaches #% at 10",
        [
            *safe("KL-E3, literal, guarded at V = 2", "V, greatest"),
            percent("KL-E3, literal, guarded at V = 2", 10)[0],
        ],
    ),
    Text(
        "is at least as good as the trace: #%, #%, #% at",
        [percent("KL-E3, p(s) by the gain", most)[0] for most in (5, 10, 20)],
    ),
    Text(
        "gives V up to # instead of #",
        [safe(label, "V, greatest")[0] for label in ("NIE, half the noise", "NIE")],
    ),
    Text("20 demonstrations succeed in #%", percent("NIE, half the noise", 20)[:1]),
]
PLAIN = [
    "for 100 s under a regulator (Q = I, R = 0.001)",
    "10 s of a backflip",
    "(64 sines, Adam 0.003, batches of 64)",
    "one step a decision on all labels and then 3,000 or 15,000",
    "100 starts from N(0, 0.1 I) for 10 s",
    "within 0.35 rad, with abs(z) below 1",
    "10 seeds (0 to 9), 5, 10 or 20 queries",
    "IQM and 95% band over seeds",
    "1,500 Adam steps, 27 s. It succeeds from 400 of 400 starts",
    "clones of 5 demonstrations from starts of the flip reached 36% instead of 95% (4 clones",
    "step of 0.2 and Sigma = 0.1 I, queries at least 2 s apart",
    "with R = 0.001, Sigma = 0.01 I",
    "saturation, 2 s apart",
    "and 5, 10 or 20 demonstrations",
    "(20 demonstrations from starts of the flip, 15,000 steps)",
    "K1, close to 100% within 5 queries",
    "with 15,000 steps,",
    "at 5.",
    "K2, NIE and MINIE stay below 50% at 20 queries",
    "asks 20 times within 2 s",
    "After 3,000 steps both are below 3%",
    "of pairs at 10 queries, all at 20",
    "at 10): the",
    "up to the 12th",
    "of 20 queries in 100 s",
    "KL-E3 with 5 of them",
    "a run of 100 s, median and greatest of 10 seeds",
    "at V = 3,",
    "at 10 and",
    "at 20, from all at 2",
    "with queries every 2 s",
    "It asks all 20 in 38 s",
    "at 5, 10 and 20 queries.",
    "within 3 s every lander is more than 1 below",
    "and three end more than 90 below",
    "(4,000 random directions)",
    "is safe at V = 2, not at 10",
    "still reaches",
    "at 10. With",
    "a guard at V = 2 reaches",
    "at 5 queries and",
    "at 10, with V",
    "a guard at V = 20",
    "deviations up to 0.03",
    "of 20 demonstrations succeed",
    "on seeds from 1000 on",
    "(steps of 0.2, 0.5 and 1 without warm start, of 0.2 and 0.5 with it, five iterations of 0.1, "
    "a variance of 0.3, no spacing) at 5 queries; spacing 2 s",
    "a step of 0.2 stays near the hover for the first 10 s, and 5 queries give 2%",
]
