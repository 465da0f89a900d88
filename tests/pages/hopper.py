"""Section "Three changes of the default, on the hopper" of docs/results/chapter3.md."""

import numpy as np
from scipy.stats import kruskal

from hybrid_rl.analysis.curves import RESAMPLES, iqm
from pages.cited import Table, Text
from pages.values import Curve, curve, p_value, read, spread

FILE, END = "hopper_ablation", 50_000
CHANGES = ("own batches", "one model per transition", "learning from random decisions")
COMBINATIONS = {  # three digits, one for each of CHANGES: 1 with it, 0 without
    one["changes"]: curve(FILE, one["label"]) for one in read(FILE)["curves"]
}
DEFAULT, NONE = COMBINATIONS["111"], COMBINATIONS["000"]
PUBLISHED = curve("defaults_hopper", "hybrid_stochastic")  # seeds 0 to 9 of DEFAULT
EARLIER = curve("variant_one_batch", "hybrid_stochastic", task="hopper")  # and of NONE
DRAWS = 20_000


def returns(label: str, column: str) -> list[float]:
    """A cell of the table of combinations."""
    line = curve(FILE, label)
    if column == "p":
        return [p_value(DEFAULT.seeds(END), line.seeds(END))]
    if column.startswith("area"):
        return spread(line.area())
    return line.at(20_000 if column == "at 20,000" else END)


def effect(label: str, column: str) -> list[float]:
    """A cell of the table of effects."""
    digit = CHANGES.index(label)
    on, off = (
        [line for digits, line in COMBINATIONS.items() if digits[digit] == value]
        for value in ("1", "0")
    )
    if column.startswith("difference"):
        values = Curve.area if column.endswith("area") else last
        return mean_difference(
            np.array([values(line) for line in on]), np.array([values(line) for line in off])
        )
    return spread(np.concatenate([last(line) for line in (off if "without" in column else on)]))


def last(line: Curve) -> np.ndarray:
    """[S] the last evaluation of each seed."""
    return line.seeds(END)


def mean_difference(on: np.ndarray, off: np.ndarray) -> list[float]:
    """Mean of on - off, both [4, S], and its 95% bootstrap band over the seeds."""
    each = (on - off).mean(0)
    draws = np.random.default_rng(0).integers(len(each), size=(RESAMPLES, len(each)))
    return [each.mean(), *np.percentile(each[draws].mean(1), [2.5, 97.5])]


def differences_by_chance() -> np.ndarray:
    """[DRAWS] difference of the IQM of two groups of ten, drawn at random from all runs."""
    every = np.concatenate([last(line) for line in COMBINATIONS.values()])
    order = np.random.default_rng(0).random((DRAWS, len(every))).argsort(1)
    one, other = every[order[:, :10]], every[order[:, 10:20]]
    return iqm(one.T) - iqm(other.T)


NOW, BEFORE = (
    np.append(first.seeds(END), last(line))
    for first, line in ((PUBLISHED, DEFAULT), (EARLIER, NONE))
)
ALL = {"default": spread(NOW), "earlier": spread(BEFORE)}  # over 30 seeds
SHIFT = EARLIER.at(END)[0] - PUBLISHED.at(END)[0]
CHANCE = differences_by_chance()
CITED = [
    Table("changes | at 20,000 | at 50,000 | area to 50,000 | p", returns),
    Table(
        "effect | IQM at 50,000 with it | without it | difference at 50,000 | difference in area",
        effect,
    ),
    Text(
        "the default has # and the earlier one #, the opposite order",
        [DEFAULT.at(END)[0], NONE.at(END)[0]],
    ),
    Text(
        "of each, the default has # [#, #] and the earlier one # [#, #] (Mann-Whitney p #)",
        [*ALL["default"], *ALL["earlier"], p_value(NOW, BEFORE)],
    ),
    Text(
        "with any one of the three left out the IQM is lower (#, # and #)",
        [COMBINATIONS[digits].at(END)[0] for digits in ("011", "101", "110")],
    ),
    Text("Kruskal-Wallis p # at", [kruskal(*map(last, COMBINATIONS.values())).pvalue]),
    Text(
        "on seeds 0 to 9 (#) in #% of draws; the standard deviation of their difference is #.",
        [SHIFT, 100 * float((np.abs(CHANCE) >= SHIFT).mean()), float(CHANCE.std())],
    ),
]
PLAIN = [
    "20 seeds each (100 to 119",
    "50,000 decisions, 5 evaluation episodes every 5,000",
    "40 learners per process",
    "IQM and 95% band; p is Mann-Whitney's against all three changes at 50,000",
    "80 runs with it against 80 without it",
    "over the 20 seeds",
    "of seeds 0 to 9. Over all 30 seeds",
    "on seeds 0 to 9 (",
    "Seeds 0 to 9 of the earlier default are",
    "excludes zero, at 50,000",
    "at 50,000). To choose",
    "from the 160 runs",
    "at 50,000, # at 75,000",
    "[over 30 seeds",
]
