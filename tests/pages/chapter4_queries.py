"""Figure 4-2, where to ask a teacher, on docs/results/chapter4.md."""

import re

import numpy as np

from pages.chapter4_exploration import interval
from pages.cited import Table, Text
from pages.values import read

ANT, LANDER, RULES = (read(f"fig_4_2{name}") for name in ("", "_lander", "_rules"))
NORMALISED, RADIUS, EIGHTY, RAW = (
    read(f"fig_4_2_{name}") for name in ("normalised", "radius", "eighty", "raw")
)
SETTINGS = read("fig_4_2_settings")


def cell(figure: dict, label: str, column: str) -> list[float]:
    """A cell of a table: IQM, low and high over seeds at N, over all N, or after the refit."""
    one = figure["methods"][label.partition(" (")[0]]
    if column == "mean over N":
        return interval(np.array(one["area_each"]))
    part = one["refit"] if column.startswith("refit") else one
    (number,) = re.findall(r"\d+", column)
    return interval(np.array(part["each"])[:, part["N"].index(int(number))])


def middle(figure: dict, label: str, column: str) -> float:
    """The first number of a cell."""
    return cell(figure, label, column)[0]


def pairs(figure: dict, label: str, reverse: bool = False, key: str = "area") -> list[float]:
    """[%] of pairs of seeds in which a rule is ahead of RQ-DAgger (reverse: behind), with band."""
    value, low, high = figure["comparisons"][label][key]
    return [100 * p for p in ((1 - value, 1 - high, 1 - low) if reverse else (value, low, high))]


def reached(label: str, column: str) -> list[float]:
    """The N at which 90% is reached: printed, refit; "never" has no number."""
    one = LANDER["methods"][label]
    return [N for N in (one["reaches"], one["refit"]["reaches"]) if N is not None]


def lander(label: str, column: str) -> list[float]:
    """A cell of the lander's table."""
    return reached(label, column) if column.startswith("90%") else cell(LANDER, label, column)


def setting(label: str, column: str) -> list[float]:
    """Mean and standard error of a rule at a radius, seeds 1000 to 1019."""
    radius = column.split()[-1]
    spread = [] if radius == "0.2" else [f"spread={radius}"]
    (one,) = [
        each
        for each in SETTINGS["present_teacher"]
        if each["rule"] == NAMES[label] and each["settings"] == spread
    ]
    return [one["mean_over_N"], one["standard_error"]]


RESIDUAL = "residual, bandwidth 0.5"
NAMES = {
    "random (RQ-DAgger)": "random",
    "residual: difference of the clone to a kernel regression of the labels": RESIDUAL,
    "disagreement of five clones": "disagreement",
    "disagreement times the density of the last 200 states": "disagreement times density",
    "oracle": "oracle",
}
FIRST = ("N = 1", "2", "4")
CLONING, RANDOM = "behaviour cloning", "RQ-DAgger"
CITED = [
    Table(
        "rule | N = 1 | 2 | 4 | 8 | 12 | mean over N | refit, N = 4 | refit, N = 12",
        lambda label, column: cell(ANT, label, column),
    ),
    Table(
        "rule | N = 4 | 8 | 12 | mean over N | refit, N = 4 | refit, N = 8 | refit, N = 12"
        " | 90% at N (printed / refit)",
        lander,
    ),
    Table("rule, ten candidates | radius 0.2 | radius 0.4 | radius 0.8", setting),
    Table(
        "rule, radius 0.4 | N = 8 | 12 | mean over N | refit, N = 4 | refit, N = 8 | refit, N = 12",
        lambda label, column: cell(RULES, label, column),
    ),
    Text("the teacher's return is #.", [ANT["teacher"]]),
    Text("DAIL has # at N = 1", [middle(ANT, "DAIL, inverse", "N = 1")]),
    Text("and # at N = 2 (`inverse`", [middle(ANT, "DAIL, inverse", "2")]),
    Text("exceeds that of DAgger in #% of the pairs [#%, #%]", pairs(ANT, "DAgger", True)),
    Text("after the refit in #%.", pairs(ANT, "DAgger", True, "refit")[:1]),
    Text(
        "oracle beat them (# against #)",
        [middle(ANT, label, "mean over N") for label in ("oracle", RANDOM)],
    ),
    Text("above that of behaviour cloning (# [#, #])", cell(ANT, CLONING, "mean over N")),
    Table(
        "rule, radius 0.2 raw | N = 1 | 2 | 4 | 8 | 12 | mean over N"
        " | refit, N = 4 | refit, N = 12",
        lambda label, column: cell(RAW, label, column),
    ),
    Text("RQ-DAgger in #% of the pairs [#%, #%], and in", pairs(RAW, "DAgger")),
    Text("and in #% after the refit", pairs(RAW, "DAgger", key="refit")[:1]),
    Text("RQ-DAgger reaches # of", [middle(RAW, RANDOM, "12")]),
    Text("at N = 12, and # after the refit.", [middle(RAW, RANDOM, "refit, N = 12")]),
    Text(
        "with bands apart (# to # against #)",
        [middle(RAW, f"DAIL, {name}", "mean over N") for name in ("trace", "inverse")]
        + [middle(RAW, "DAgger", "mean over N")],
    ),
    Text("random queries in #% of the pairs [#%, #%], by `trace`", pairs(RAW, "DAIL, inverse")),
    Text("by `trace` in #% [#%, #%]", pairs(RAW, "DAIL, trace")),
    Text("here either: # at N", [middle(RAW, "DAIL, inverse", "2")]),
    Text(
        "RQ-DAgger has #, #, # at N = 1, 2, 4, where",
        [middle(NORMALISED, RANDOM, N) for N in FIRST],
    ),
    Text("where it has #, #, # above", [middle(ANT, RANDOM, N) for N in FIRST]),
    Text(
        "goes on to # at N = 12, and to # after",
        [middle(NORMALISED, "residual", N) for N in ("12", "refit, N = 12")],
    ),
    Text("The teacher has #. 10 seeds", [LANDER["teacher"]]),
    Text("(DAgger is ahead in #% of the pairs [#%, #%])", pairs(LANDER, "DAgger")),
    Text("RQ-DAgger\n  has # [#, #]", cell(LANDER, RANDOM, "refit, N = 12")),
    Text("and DAgger # [#, #]; DAgger", cell(LANDER, "DAgger", "refit, N = 12")),
    Text("DAgger is ahead in #% of the pairs [#%, #%]. It", pairs(LANDER, "DAgger", key="refit")),
    Text(
        "mean over N (# to # against #)",
        [
            *(middle(LANDER, f"DAIL, {name}", "mean over N") for name in ("trace", "gain")),
            middle(LANDER, RANDOM, "mean over N"),
        ],
    ),
    Text(
        "cloning goes from # to # at N = 12, `trace` from # to #",
        [
            middle(LANDER, label, column)
            for label in (CLONING, "DAIL, trace")
            for column in ("12", "refit, N = 12")
        ],
    ),
    Text("rule is ahead of random queries in #% of the pairs [#%, #%]", pairs(RULES, "residual")),
    Text("and the oracle in #% [#%, #%]", pairs(RULES, "oracle")),
    Text("the residual rule has # [#, #], random", cell(RADIUS, "residual", "mean over N")),
    Text("random queries # [#, #]:", cell(RADIUS, RANDOM, "mean over N")),
    Text(": #% [#%, #%]. Part", pairs(RADIUS, "residual")),
    Text("the mean over N is # [#, #] against", cell(EIGHTY, "residual", "mean over N")),
    Text("against # [#, #], 55%", cell(EIGHTY, RANDOM, "mean over N")),
    Text("], #% of the pairs [#%, #%]. It is", pairs(EIGHTY, "residual")),
    Text(
        "same clone it has #, #, # at N = 1, 2, 4",
        [middle(ANT, "residual", N) for N in FIRST],
    ),
    Text(
        "4, against #, #, # of random",
        [middle(ANT, RANDOM, N) for N in FIRST],
    ),
    Text(
        "observations #, #, # against",
        [middle(NORMALISED, "residual", N) for N in FIRST],
    ),
    Text(
        "against #, #, #: none either",
        [middle(NORMALISED, RANDOM, N) for N in FIRST],
    ),
    Text(
        "queries at 0.4 have # in the mean over N, the oracle at 0.2 (seeds 0 to 9) #.",
        [
            middle(RULES, RANDOM, "mean over N"),
            middle(LANDER, "oracle", "mean over N"),
        ],
    ),
]
PLAIN = [
    "(2 x 32 ReLU, Adam 0.003, batches of 64)",
    "one demonstration of 1,000 decisions, on which",
    "200 steps are taken",
    "A refit takes 15,000 steps",
    "Radius: 0.2 standard",
    "(the thesis: 0.2 in raw",
    "thesis prints 0.2 in raw units. Of positions and angles that is 2 to 25 times",
    "10 seeds (0 to 9), 10 episodes of 1,000 decisions",
    "one program of 10 seeds",
    "[95% band]",
    "at N = 2, with one step",
    "rule reaches 90% of",
    "any N up to 12",
    "at N = 1 and",
    "at N = 2 (`inverse`",
    "at N = 1, 2, 4",
    "4 episodes an evaluation, N up to 4",
    "(seeds 1000 to 1003)",
    "at N = 12",
    "still below 90%",
    "Demonstrations of 100 decisions",
    "share of 100 flights",
    "10 seeds, two CPU",
    "no rule reaches 90% within",
    "lander, seeds 1000 to 1019",
    "seeds 0 to 19, radius 0.4",
    "At radius 0.8 (seeds 0 to 19",
    "advantage on seeds 1000 to 1019",
    "80 more seeds (20 to 99, radius 0.4",
    "on seeds 0 to 19 random queries at 0.4 have",
    "oracle at 0.2 (seeds 0 to 9)",
    "`fig_4_2_settings.json`, seeds 1000 to 1019",
    "kernel regression, 50 candidates",
    "last 200 states",
    "(seeds 1000 to 1009): tanh",
]
