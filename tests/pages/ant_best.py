"""The ant's clones at their best, on docs/results/robots.md."""

import numpy as np

from pages.ant import ANT, below, earlier, expert, min_and_max, six, spread
from pages.cited import Table, Text

BEST = ANT["best"]
SCRIPT, CHOICE = BEST["script"], BEST["choice"]


def share(seeds: np.ndarray | list[float]) -> float:
    """[%] of the expert's return."""
    return 100 * float(np.mean(seeds) / expert().mean())


def best(demonstrations: int) -> list[float]:
    """Mean return of each seed."""
    (row,) = (row for row in BEST["rows"] if row["demonstrations"] == demonstrations)
    assert (row["seeds"], row["episodes"]) == (list(range(10)), 100)
    return row["mean"]


def cloned(label: str, column: str) -> list[float]:
    """A cell of the table of the ant's clones."""
    of = earlier if "earlier" in column else best
    seeds = of(int(label.split()[0]))
    return [share(seeds)] if "share" in column else spread(seeds)


CITED = [
    Table(
        "cloned from | mean return | share of the expert's | mean return, earlier settings"
        " | share, earlier settings",
        cloned,
    ),
    Text("Six demonstrations give #% of the expert's return", [share(best(6))]),
    Text(
        "the seeds range from #% to #%, so",
        [100 * seed / float(expert().mean()) for seed in min_and_max(best(6))],
    ),
    Text(
        "seeds 0 to 9 have # [#, #], #%, and #% of the",
        [*spread(SCRIPT["mean"]), share(SCRIPT["mean"]), 100 * SCRIPT["below"]],
    ),
    Text(
        "on seeds 200 to 204, where it had #; clipping alone had # there",
        [float(np.mean(CHOICE[name]["mean"])) for name in ("all three", "clipped alone")],
    ),
    Text("Under the earlier settings** it was #%", [share(earlier(6))]),
    Text("the median episode has #%", [100 * float(np.median(six()) / expert().mean())]),
    Text("#% of the episodes have\n  returns below 1,000", [below(six())]),
    Text(
        "the others reach # on average, #%",
        [float(np.mean(six()[six() >= 1000])), share(six()[six() >= 1000])],
    ),
]
PLAIN = [
    "five clones of four layers of 256 silu units",
    "2,500 gradient steps at 0.003 on",
    "Demonstrated actions of 0.95 or more count as clipped",
    "Return over 400 decisions, 100 episodes a seed: mean over",
    "seeds 0 to 9, lowest and highest seed, one core",
    "3, 8 and 10 demonstrations ran",
    "just above 95%",
    "seeds 0 to 9 have",
    "have less than 1,000. The combination",
    "was chosen on seeds 200 to 204",
    "returns below 1,000, and the others",
]
