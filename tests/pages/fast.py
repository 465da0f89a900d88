"""docs/results/lookahead.md: settings=fast, fewer updates of the models, averaged weights."""

from pages.cited import Table, Text
from pages.values import Curve, curve, number, read

TIMES, SPEED = read("hybrid_fast")["times"], read("lookahead_speed")["fast"]
FAST, DEFAULT = "settings=fast", "hybrid_stochastic"


def line(task: str, label: str = FAST) -> Curve:
    """A line of the picture of four robots."""
    return curve("hybrid_fast", label, task=task.replace("-", ""))


def returns(label: str, column: str) -> list[float]:
    """A cell of the table of four robots."""
    task, step = label.split(", ")
    each = line(task).seeds(number(step))
    kind = {f"{FAST}, mean": each.mean, f"{FAST}, lowest seed": each.min}
    return [float(kind[column]())] if column in kind else line(task, column).at(number(step))


def rate(learners: float, column: str = FAST) -> float:
    """Decisions per second."""
    return SPEED[column][f"{learners:.0f}"]["decisions_per_s"]


def behind(task: str, step: int) -> float:
    """[%] that the IQM is below that of the default."""
    return 100 * (1 - line(task).at(step)[0] / line(task, DEFAULT).at(step)[0])


def choice(label: str, column: str) -> list[float]:
    """A cell of the table of the seeds of the choice."""
    task, step = label.split(", ")
    return curve("updates_choice", column, task=task.replace("-", "")).at(number(step))


def lowest(label: str, count: int) -> list[float]:
    """The lowest returns at 30,000 decisions of the half-cheetah, on the seeds of the choice."""
    each = curve("updates_choice", label, task="halfcheetah").seeds(30_000)
    return sorted(map(float, each))[:count]


CITED = [
    Table(
        f"ten seeds, IQM and 95% band | {DEFAULT} | {FAST} | {FAST}, its policy alone "
        f"| {FAST}, mean | {FAST}, lowest seed",
        returns,
    ),
    Text(
        "decisions in # minutes**, from the command to the end, with # s of compiling and ten "
        "evaluations, on one H100 and eight processors with nothing else on them (a run of its "
        "own, with the same returns); ten walkers in #. The",
        [
            TIMES["halfcheetah"]["wall_s"] / 60,
            TIMES["halfcheetah"]["compile_s"],
            TIMES["walker2d"]["wall_s"] / 60,
        ],
    ),
    Text(
        "At 100,000 the mean is #, above the mean of the best published curve, 11,177, and of the "
        "default, #; the",
        [float(line("halfcheetah", label).seeds(100_000).mean()) for label in (FAST, DEFAULT)],
    ),
    Text(
        "the lowest has # at 20,000 and # at 100,000.",
        [float(line("halfcheetah").seeds(step).min()) for step in (20_000, 100_000)],
    ),
    Text(
        "ant and walker have #% and #% less",
        [behind("ant", 50_000), behind("walker2d", 100_000)],
    ),
    Text("With ten learners it makes # times", [rate(10) / rate(10, "default")]),
    Table(
        f"one H100, decisions/s | default | {FAST}",
        lambda label, column: [rate(number(label), column)],
    ),
    Text("With 64 learners it is # times as fast", [rate(64) / rate(64, "default")]),
    Table(
        "five seeds, IQM and 95% band | the default | one update of the models "
        "| mean of the weights acts",
        choice,
    ),
    Text(
        "fall to # and # at 30,000, where the lowest of the default has #.",
        [*lowest("one update of the models", 2), *lowest("the default", 1)],
    ),
]
PLAIN = [
    "Seeds 100 to 109, TF32, one H100, which",
    "half-cheetahs to 100,000 decisions in",
    "The default takes 11 to 12 minutes",
    "gait of about 2,000: the",
    "at 20,000 and",
    "at 100,000.\n* **The other robots",
    "reaches 3,000 after 30,000 decisions instead of 15,000, where the default's lead at 20,000",
    "Seeds 200 to 204, TF32, one H100 that",
    "35,000 and 30,000 decisions",
    "at 30,000, where",
    "a share of 0.001 of the new weights at each update, thus a mean over about 500 decisions",
    "at 10,000 and 30,000 the bands",
    "the best published curve, 11,177, and",
    "after the first 20,000 decisions",
    "With 64 learners it is",
]
