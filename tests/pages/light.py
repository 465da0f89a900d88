"""docs/results/lookahead.md: settings=light, each half alone and each part taken away."""

import numpy as np

from hybrid_rl.analysis.curves import iqm
from pages.cited import Table, Text
from pages.values import Curve, curve, number, parts, read, spread

TEN = "a planner of ten decisions"


def half(task: str, label: str) -> Curve:
    """A line of the picture of each half alone."""
    return curve("light_halves", label, task=task.replace("-", ""))


def planned(label: str, column: str) -> list[float]:
    """A cell of the table of planners of trained learners."""
    rows = read("planner_trained")["tasks"][column.split(",")[0]]
    if "gain" in column:
        return [float(np.sum(np.array(rows[label]) > np.array(rows["policy alone"])))]
    return spread(np.array(rows[label]))


def more(task: str, label: str) -> float:
    """[%] that a planner's IQM is above that of the policy alone."""
    return 100 * (planned(label, task)[0] / planned("policy alone", task)[0] - 1)


def ten_seeds(task: str, label: str = "settings=light") -> Curve:
    """A line of the picture of updates from the start."""
    return curve("light_early", label, task=task.replace("-", ""))


def early(label: str, column: str) -> list[float]:
    """A cell of the table of updates from the start."""
    task, step = label.split(", ")
    if column == "lowest seed":
        return [float(ten_seeds(task).seeds(number(step)).min())]
    return ten_seeds(task, column).at(number(step))


CITED = [
    Table(
        "IQM and 95% band, ten seeds | without updates from the start | settings=light "
        "| its policy alone | lowest seed",
        early,
    ),
    Table(
        "planner of a trained hybrid | half-cheetah | half-cheetah, gain | hopper | hopper, gain",
        planned,
    ),
    Text(
        "better than the policy by more than #%",
        [
            np.ceil(
                max(
                    more("half-cheetah", label)
                    for label in read("planner_trained")["tasks"]["half-cheetah"]
                )
            )
        ],
    ),
    Text(
        "better for each of the ten seeds**, by #% (IQM)",
        [more("hopper", "64 candidates, 10 decisions")],
    ),
    Table(
        "settings=light, one change | IQM and band, 10,000 | 20,000 | 30,000 | lowest seed, 30,000",
        parts("light_parts"),
    ),
    Table(
        "settings=light, IQM and 95% band | hybrid_stochastic | policy alone | planner alone",
        lambda label, column: half(label.split(",")[0], column).at(number(label)),
    ),
    Text(
        "trained with it, have # [#, #] at 25,000 and # [#, #] at 30,000 decisions, its policy "
        "alone # there; with the planner of `settings=light` they have # [#, #] and # [#, #].",
        [
            *(x for step in (25_000, 30_000) for x in half("hopper", TEN).at(step)),
            float(iqm(np.array(read("planner_trained")["policy_of_ten_decisions"]))),
            *(x for step in (25_000, 30_000) for x in half("hopper", "hybrid_stochastic").at(step)),
        ],
    ),
    Text(
        "is as good as both (# at 30,000 on the half-cheetah, # on the hopper)",
        [
            half(task, "hybrid_stochastic, its policy").at(30_000)[0]
            for task in ("half-cheetah", "hopper")
        ],
    ),
]
PLAIN = [
    "during the 5,000 random decisions",
    "on seeds 200 to 204 (in the picture). Here seeds 100 to 109",
    "overlap at 20,000 decisions; at 10,000 and 30,000 they do",
    "overlap at 20,000; at 30,000 the IQM",
    "It costs 5,000 more decisions",
    "at 25,000 and",
    "at 30,000 decisions, its policy",
    "after 30,000 decisions, evaluated again with other fields of their planner (16 candidates, "
    "all of the policy, 3 decisions, temperature 0.3)",
    "seeds 100 to 109, one core of an AMD EPYC, float32; one change",
    # read from the console; the page says so
    "at 30,000, and a decision takes longer: about 95 decisions/s instead of 140 to 240",
    "seeds 100 to 109, one core of an AMD EPYC, float32, evaluations every 5,000",
    "64 candidates, 20 decisions, and no critic",
    "from 10,000 decisions on, but",
    "at 30,000, and less at 25,000",
    "at 30,000 on the half-cheetah",
]
