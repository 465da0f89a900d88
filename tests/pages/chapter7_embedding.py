"""Figure 7-4 in docs/results/chapter7.md."""

from pages.cited import Table, Text
from pages.values import read

TABLE = read("fig_7_4_table")
ROWS = {
    "linear": "linear_p0.01",
    "random features": "random",
    "learned, noise": "noise",
    "learned, information gain": "gain",
    "learned, norm": "norm",
    "learned, noise, K by Adam": "adam",
}
COLUMNS = {
    "T = 5 (thesis), start 0.1 rad": ("0.1", 5),
    "T = 32, start 0.1": ("0.1", 32),
    "T = 64, start 0.30": ("0.3", 64),
    "T = 128, start 0.38": ("0.38", 128),
}


def cart(label: str, column: str) -> list[float]:
    """Median and quartiles of the iterations, unless half never are; share at the end [%]."""
    start, horizon = COLUMNS[column]
    one = TABLE["cart_pendulum"].get(f"{start}/{ROWS[label]}_{horizon}")
    if one is None:
        return []
    counts = one["median_quartiles"]
    return [*(counts if counts[0] is not None else []), 100 * one["share_at_end"]]


def arm(label: str, column: str) -> list[float]:
    """Share [%] within 0.05 rad at an iteration, over all programs of the row."""
    one = TABLE["two_link"][f"{ROWS[label]}_32"]
    return [100 * one["share_within"][int(column) - 1]]


CITED = [
    Table(" | " + " | ".join(COLUMNS), cart),
    Table(" | 1 | 2 | 5 | 20", arm),
    Text(
        "median attempt (# rad with the gain)",
        [TABLE["two_link"]["gain_32"]["distance_median"][4]],
    ),
]
PLAIN = [
    "An iteration is 200 decisions",
    "(7 to 12 of them",
    "then 5 greedy episodes",
    "is all 5 whole",
    "20 seeds (0 to 19)",
    "seeds 1000 to 1005",
    "40% of full actuation x 0.9^i",
    "100% x 0.2^i",
    "T = 32.",
    "after 50 iterations actively, over 100 with noise",
    "(spectral radius 1.005)",
    "with 0.01 instead of 10",
    "6 to 40 times",
    "norm at T = 128",
    "T = 32: share",
    "100 greedy attempts that end within 0.05 rad of the target after 2 s",
    "one attempt of 2 s each",
    "within 5 iterations",
    "a horizon of 32",
    "printed horizon of 5",
    "(0.2% of the targets)",
]
