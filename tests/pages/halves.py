"""docs/results/lookahead.md: runs made twice, fifty seeds, each half alone, the critic's error."""

from pages.cited import Table, Text
from pages.values import Curve, curve, number, read


def both_times(task: str) -> list[float]:
    """IQM at 20,000 decisions of the first runs of seeds 100 to 109 and of those of the page."""
    first = curve("hybrid_first", "hybrid_stochastic", task=task)
    return [first.at(20_000)[0], curve(f"hybrid_{task}", "hybrid_stochastic").at(20_000)[0]]


def fifty(label: str, column: str) -> list[float]:
    """A cell of the table of fifty seeds."""
    one = curve("hybrid_fifty", "hybrid_stochastic")
    each = one.seeds(number(label))
    if column == "mean":
        return [float(each.mean())]
    if column == "lowest seed":
        return [float(each.min())]
    return [float((each < 2_500).sum())] if "below" in column else one.at(number(label))


def half(task: str, label: str) -> Curve:
    """A line of the picture of each half alone."""
    return curve("light_halves", label, task=task.replace("-", ""))


ERROR = read("critic_error")["rows"]
CITED = [
    Table(
        "the critic's error | 10,000 | 20,000 | 40,000",
        lambda label, column: [100 * ERROR[label][str(round(number(column)))]["relative"]],
    ),
    Text("stopped at 20,000 with # there, these have #:", both_times("hopper")),
    Text("Its first runs had # at 20,000, these have #.", both_times("ant")),
    Table(
        "half-cheetah, fifty seeds | IQM and 95% band | mean | lowest seed | seeds below 2,500",
        fifty,
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
    "ended them after 10,000 decisions",
    "Seeds 100 to 149 in one program",
    "stopped it after 49,000 decisions",
    "gait of about 2,000**",
    "below 2,500 at 10,000",
    "and 20,000 have more than 5,000 from 30,000 on; the evaluation at 50,000 is",
    "seeds 100 to 109, one core of an AMD EPYC, float32, evaluations every 5,000",
    "64 candidates, 20 decisions, and no critic",
    "from 10,000 decisions on, but",
    "at 30,000, and less at 25,000",
    "at 30,000 on the half-cheetah",
    # read from the log; the page says so
    "made 2,983 decisions/s and took 906 s to 49,000 decisions of each seed, 59 s of",
]
