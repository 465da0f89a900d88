"""README.md: its results."""

from pages import chapter3, chapter6_values, results
from pages.cited import Table, Text
from pages.values import curve, number

PAGE = "README.md"


def main_table(label: str, column: str) -> list[float]:
    """A cell of the row "thesis settings, half-cheetah, 40,000 decisions", say."""
    settings, task = label.split(", ", 1)
    task = task[: task.rindex(", ")]
    of = chapter3.thesis if settings == "thesis settings" else chapter3.default
    return of(task, column).at(number(label))[:1]


def sac(label: str, x: float) -> list[float]:
    """IQM and band beside Stable-Baselines3."""
    return results.curve(results.FILE, label, task="halfcheetah").at(x)


KLE3 = chapter6_values.SEARCHES["kle3_bayesopt"]
CITED = [
    Text("to a return of # (", [curve("light_halfcheetah", "settings=light").at(60_000)[0]]),
    Table(" | hybrid_stochastic | nn_mppi | sac", main_table),
    Text(
        "half-cheetah 5,000 within # decisions, # at 100,000",
        [chapter3.passes(chapter3.CHEETAH, 5_000)[1], chapter3.CHEETAH.at(100_000)[0]],
    ),
    Text(
        "on our half-cheetah (# [#, #] and # [#, #] at 100,000)",
        [*sac("sac", 100_000), *sac(results.OURS, 100_000)],
    ),
    Text(
        "(# and #, disjoint bands) and #% behind at 100,000 (# [#, #]; Mann-Whitney p #,",
        [
            sac("sac", 50_000)[0],
            sac(results.GYM, 50_000)[0],
            results.behind(),
            *sac(results.GYM, 100_000),
            results.p(100_000, results.GYM),
        ],
    ),
    Text("rail in # of # trials", chapter6_values.search(KLE3, "trials that get there")),
    Text(
        "needs # measurements where LQR-Bayesian optimisation needs #, # times as many",
        [chapter6_values.KLE3, chapter6_values.LQR, chapter6_values.LQR / chapter6_values.KLE3],
    ),
    Text(
        "and # where it needs #, # times as many",
        [*chapter6_values.QUICK[::-1], chapter6_values.QUICK[0] / chapter6_values.QUICK[1]],
    ),
]
PLAIN = [
    # settings and versions
    "Python 3.11 to 3.13",
    "(Northwestern University, 2020)",
    "10 seeds (0 to 9)",
    "seeds 0 to 2",
    "half-cheetah 5,000 within",
    "at 100,000",
    "it is ahead at 50,000",
    "10 seeds against 5",
    "(position weight 5)",
    "(position weight 500)",
    "| 6.1, 6.2, Algorithm 6 |",
    "baseline of 6.1",
    "SE(3)",
    "for up to 40 worlds a core",
    "two cores of a 2.5 GHz Xeon",
    "60,000 decisions in about three minutes on two cores",
    "ends with exit code 1",
    "50,000 decisions of the half-cheetah take hours",
    "CUDA 13",
    "jaxlib 0.10",
    "Apache-2.0",
    # aims
    "where 600 are the aim",
    # read off the console; docs/results says so
    "about 4 decisions a second",
    "about 19 minutes for 100,000 decisions",
    "about 210 a second",
]
