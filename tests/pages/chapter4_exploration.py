"""The half-cheetah that explores by disagreement, on docs/results/chapter4.md."""

import numpy as np
from scipy.stats import fisher_exact

from hybrid_rl.analysis.curves import band, iqm
from pages.cited import Table, Text
from pages.values import curve, read

CURVES, MIXED = "exploration_halfcheetah", "exploration_mixed"
MODELS = read("exploration_model")["runs"]
STUCK = 3000
KINDS = {"policies": "learned policies", "random": "random actions"}
END = 50_000


def interval(values: np.ndarray) -> list[float]:
    """IQM, low and high of [S]."""
    low, high = band(values)
    return [float(iqm(values)), float(low), float(high)]


def returns(label: str, column: str) -> list[float]:
    """A cell of the table of returns."""
    line = curve(CURVES, label)
    if column.startswith("seeds below"):
        return [stuck(CURVES, label)]
    if column.startswith("mean"):
        return interval(line.area())
    return line.at(float(column.split()[-1].replace(",", "")))


def stuck(name: str, label: str) -> int:
    """Seeds below 3,000 at the end."""
    return int((curve(name, label).seeds(END) < STUCK).sum())


def model(label: str, column: str) -> list[float]:
    """A cell of the table of held-out errors."""
    kind, step = column.split(", after ")
    return interval(np.array(MODELS[f"{label}: {step}"][KINDS[kind]]["each"]))


def pairs_below(label: str, other: str) -> float:
    """[%] of pairs of seeds in which the return of `label` is below that of `other`."""
    a, b = (curve(CURVES, each).seeds(END) for each in (label, other))
    return 100 * float((a[:, None] < b[None]).mean())


TRAPPED = stuck(CURVES, "1,000 random")
WITH_REWARD = "reward and {}disagreement, seeds from 1000"
CITED = [
    Table(
        "first decisions | return at 5,000 | at 20,000 | at 50,000 | mean of the curve"
        " | seeds below 3,000 at 50,000",
        returns,
    ),
    Table(
        "first decisions | policies, after 5,000 | policies, after 50,000 | random, after 5,000"
        " | random, after 50,000",
        model,
    ),
    Text("random decisions in #% of the pairs", [pairs_below("disagreement", "5,000 random")]),
    Text(
        "at 50,000 is # with equal weights and # with a",
        [curve(MIXED, WITH_REWARD.format(w)).at(END)[0] for w in ("", "0.1 ")],
    ),
    Text("random decisions # of 10 seeds end below", [stuck(CURVES, "1,000 random")]),
    Text("over all 50 seeds: p #)", [fisher_exact([[TRAPPED, 10 - TRAPPED], [0, 40]]).pvalue]),
]
OTHERS = ("5,000 random", "noise, policy learns", "disagreement")
assert not sum(stuck(CURVES, label) for label in OTHERS)
assert not stuck(MIXED, "5,000 random, seeds from 10")
PLAIN = [
    "first 5,000 decisions explore",
    "horizon 20, 64 candidates) from decision 1,000 to 5,000, then",
    "1,000 random decisions\n(as by `settings=mbpo`), 5,000 random decisions",
    "noise from 1,000 to 5,000 while",
    "Seeds 0 to 9, no setting",
    "jax 0.11",
    "after\n  5,000 decisions and after 50,000, and its return at 50,000 is below that of 5,000",
    "seeds 1000 to 1009",
    "the return at 50,000 is",
    "With 1,000 random decisions",
    "of 10 seeds end below 3,000; with 5,000\n  decisions",
    "over all 50 seeds",
    "none of 30, nor of ten more seeds (10 to 19) with 5,000 random decisions",
]
