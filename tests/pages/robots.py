"""docs/results/robots.md."""

import numpy as np

from pages.cited import ROOT, Table, Text
from pages.values import ahead, curve, number

PAGE = "docs/results/robots.md"


def expert() -> np.ndarray:
    """Return of each of the ant's demonstrated episodes."""
    with np.load(ROOT / "demonstrations" / "ant.npz") as file:
        return np.bincount(file["episode"], file["reward"])


def stacked(label: str, column: str) -> list[float]:
    """[%] of successes: mean, lowest and highest seed."""
    each = 100 * curve("fig_3_6", label).seeds(number(column))
    return [each.mean(), each.min(), each.max()]


CITED = [
    Table(
        "after 20 episodes | evaluation return, IQM and 95% band",
        lambda label, _: curve("fig_3_3", label).at(2_000),
    ),
    Table("demonstrations | 1 | 2 | 3 | 5 | 10", stacked),
    Text("have # on average", [expert().mean()]),
    Table(
        "demonstrations | 1 | 2 | 3 | 4 | 6 | 8 | 10",
        lambda label, column: curve("fig_3_5", label).at(number(column)),
    ),
    Text(
        "cloning ahead in #% [#, #] of pairs",
        ahead(curve("fig_3_5", "bc").area(), curve("fig_3_5", "hybrid_bc").area()),
    ),
    Text("Its ten episodes, # to #, are", [expert().min(), expert().max()]),
]
PLAIN = [
    # settings
    "seeds 0 to 9, 10 evaluation episodes per seed",
    "jax 0.11.2",
    "episodes of 10 s",
    "within 20 episodes",
    "of 100 episodes: mean over seeds",
    "from 5 demonstrations on",
    "learn at 0.003: with the thesis' rate of 0.01",
    "for 1 cm",
    "over 400 decisions",
    "IQM and 95% band; parameters of the thesis",
    "the thesis' 20 decisions",
    "a rate of 0.003",
    "the thesis' rate of 0.01",
    "over 64 worlds, eight updates for 64 decisions, 2.4 M decisions",
    "10,000 random decisions in each of 256 worlds",
    "10,000 random decisions on MJX. The Sawyer's 20 episodes",
]
