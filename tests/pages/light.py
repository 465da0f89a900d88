"""docs/results/lookahead.md: settings=light, each half alone and each part taken away."""

from pages.cited import Table, Text
from pages.values import Curve, curve, number


def half(task: str, label: str) -> Curve:
    """A line of the picture of each half alone."""
    return curve("light_halves", label, task=task.replace("-", ""))


def part(label: str, column: str) -> list[float]:
    """A cell of the table of parts."""
    one = curve("light_parts", label)
    step = number(column.split(", ")[-1])
    return [float(one.seeds(step).min())] if "lowest" in column else one.at(step)


CITED = [
    Table(
        "settings=light, one change | IQM and band, 10,000 | 20,000 | 30,000 | lowest seed, 30,000",
        part,
    ),
    Table(
        "settings=light, IQM and 95% band | hybrid_stochastic | policy alone | planner alone",
        lambda label, column: half(label.split(",")[0], column).at(number(label)),
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
    "seeds 100 to 109, one core of an AMD EPYC, float32; one change",
    # read from the console; the page says so
    "at 30,000, and a decision takes longer: about 95 decisions/s instead of 140 to 240",
    "seeds 100 to 109, one core of an AMD EPYC, float32, evaluations every 5,000",
    "64 candidates, 20 decisions, and no critic",
    "from 10,000 decisions on, but",
    "at 30,000, and less at 25,000",
    "at 30,000 on the half-cheetah",
]
