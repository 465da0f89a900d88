"""docs/results/lookahead.md."""

from pages.cited import Table, Text
from pages.values import Curve, curve, number, read

PAGE = "docs/results/lookahead.md"
SETTINGS, ALONE = "settings=lookahead", "without the planner"
BEFORE, DEFAULT = "discount 0.99, learned ends", "the default, seeds 0 to 9"


def line(task: str, label: str = SETTINGS) -> Curve:
    """A line of a picture of this page; the half-cheetah has no ends."""
    task = task.replace("-", "")
    if task == "halfcheetah" and label == BEFORE:
        label = "discount 0.99"
    return curve(f"lookahead_{task}", label)


def returns(label: str, column: str) -> list[float]:
    """A cell of the first table."""
    task, step = label.split(",")[0], number(label)
    if column == DEFAULT:
        return curve(f"defaults_{task.replace('-', '')}", "hybrid_stochastic").at(step)
    return line(task, column).at(step)


def means(task: str, label: str, *steps: int) -> list[float]:
    """Means over the seeds at these numbers of decisions."""
    return [float(line(task, label).seeds(step).mean()) for step in steps]


def lowest(task: str, label: str, step: int) -> float:
    """The return of the worst seed."""
    return float(line(task, label).seeds(step).min())


def parts(label: str, column: str) -> list[float]:
    """A cell of the table of parts."""
    each = curve("lookahead_parts", label).seeds(10_000)
    kind = {"mean return": each.mean, "lowest seed": each.min, "highest seed": each.max}
    return [float(kind[column]())]


def signal(label: str, column: str) -> list[float]:
    """A cell of the table of the agreement signal."""
    metric = {
        "plain": "planner/mode_insertion_gradient",
        "per unit of variance": "planner/insertion_per_variance",
        "variance": "planner/policy_variance",
    }[column]
    return curve("lookahead_agreement", "hybrid_stochastic", metric).at(number(label))


SPEED = read("lookahead_speed")["rows"]
CITED = [
    Table(
        f"evaluation return, IQM and 95% band | {SETTINGS} | {BEFORE} | {ALONE} | {DEFAULT}",
        returns,
    ),
    Text(
        "Our mean over the five seeds is # at 20,000 and # at 30,000; "
        "with a discount of 0.99 it is # at 20,000, # at 30,000 and # at 40,000. "
        "There the worst of the five seeds has #",
        [
            *means("half-cheetah", SETTINGS, 20_000, 30_000),
            *means("half-cheetah", BEFORE, 20_000, 30_000, 40_000),
            lowest("half-cheetah", BEFORE, 40_000),
        ],
    ),
    Text("The lowest of five seeds has # at 20,000", [lowest("hopper", SETTINGS, 20_000)]),
    Text(
        "at 30,000 the mean is #, with # in one seed",
        [*means("hopper", SETTINGS, 30_000), lowest("hopper", SETTINGS, 30_000)],
    ),
    Text(
        "in models and reward #, five critics of 512 units with a pessimistic mean #, against #",
        [
            line("hopper", label).at(25_000)[0]
            for label in (
                "SiLU, no layer normalisation in models",
                "five larger critics, pessimistic",
                SETTINGS,
            )
        ],
    ),
    Text(
        "the IQM is # instead of #",
        [line("walker2d", label).at(25_000)[0] for label in (SETTINGS, BEFORE)],
    ),
    Table("at 10,000 decisions | mean return | lowest seed | highest seed", parts),
    Text(
        "# decisions/s after # s of compilation, or # after # s without Triton's",
        [row[key] for row in SPEED.values() for key in ("decisions_per_s", "compile_s")],
    ),
    Table("half-cheetah | plain | per unit of variance | variance", signal),
]
PLAIN = [
    # settings, and where the text points at a decision
    "within 20 decisions",
    "while the 5,000 random decisions",
    "first temperature is 0.1",
    "The discount is 0.995",
    "the discount was 0.99",
    "on seeds 200 to 204, which",
    "(seeds 200 to 209)",
    "at 20,000 decisions, ahead of it at 30,000.",
    "at 20,000 and",
    "at 30,000; with a discount of 0.99 it is",
    "at 20,000, 9",
    "at 30,000 and 9",
    "at 40,000. There the",
    "gait of about 2,000",
    "at 20,000 decisions, where",
    "at 30,000 the mean",
    "a discount of 0.99 and learned ends one of five seeds stayed below 1,000",
    "(25,000 decisions, same seeds",
    "five critics of 512 units",
    "At 25,000 decisions",
    "(10,000 to 20,000 decisions",
    "10,000 decisions, seeds 200 to 204",
    "critics of 512",
    "tau 0.01",
    "by 10,000 decisions",
    "three layers of 256",
    "batches of 512",
    "on 5,000 decisions of other policies",
    # what others published
    "DHMBPO has 7,532 at 20,000, 8,059 at 30,000 and 9,149 at 50,000, MBPO 4,277, 5,842 and 7,948",
    "Gymnasium's version 4)",
    "where DHMBPO has 2,898",
    "DHMBPO has 3,375",
    "DHMBPO has 6,150 at 50,000",
    # read from the console; the page says so
    "makes 1,427 on an H200",
]
