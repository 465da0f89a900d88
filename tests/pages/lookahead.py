"""docs/results/lookahead.md."""

import numpy as np

from pages import default, fast, layer_norm, light, published
from pages.cited import Table, Text
from pages.values import Curve, curve, number, read

PAGE = "docs/results/lookahead.md"
SETTINGS, ALONE = "today's default", "without the planner"
BEFORE, DEFAULT = "discount 0.99, learned ends", "settings=mbpo, seeds 0 to 9"


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


def hybrid(task: str, label: str = "hybrid_stochastic") -> Curve:
    """A line of the pictures of seeds 100 to 109."""
    return curve(f"hybrid_{task.replace('-', '')}", label)


def reported(label: str, column: str) -> list[float]:
    """A cell of the table of the reported seeds."""
    return hybrid(label.split(",")[0], column).at(number(label))


def compared(label: str, column: str) -> list[float]:
    """A cell of this page's table beside DHMBPO's numbers."""
    return published.beside(hybrid(label.split(",")[0]), label, column)


def both_times(task: str) -> list[float]:
    """IQM at 20,000 decisions of the first runs of seeds 100 to 109 and of those of the page."""
    first = curve("hybrid_first", "hybrid_stochastic", task=task)
    return [one.at(20_000)[0] for one in (first, hybrid(task))]


def longer(label: str, column: str) -> list[float]:
    """A cell of the table of 400,000 decisions."""
    kind = {"mean return": np.mean, "lowest seed": np.min, "highest seed": np.max}
    each = curve("hybrid_long", "hybrid_stochastic").seeds(number(label))
    return [float(kind[column](each))]


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
BESIDE = [
    one["decisions_per_s"]
    for one in read("lookahead_speed")["side_by_side"].values()
    if isinstance(one, dict)
]
EARLIER = [curve("hybrid_halfcheetah_first", f"{which} runs") for which in ("first", "second")]
FIRST = curve("hybrid_long", "first runs")
LONG_TIMES = read("hybrid_long")["times"]


TARGETS = read("target_statistics")["rows"]
MOVED = [
    TARGETS[label]["iqm"][TARGETS[label]["step"].index(step)]
    for label, step in (
        ("hybrid_stochastic, averaged statistics", 20_000),
        ("hybrid_stochastic, averaged statistics", 50_000),
        ("hybrid_stochastic, the critic's statistics", 20_000),
        ("hybrid_stochastic, the critic's statistics", 50_000),
        ("sac, averaged statistics", 50_000),
        ("sac, the critic's statistics", 50_000),
    )
]
CITED = [
    Text("of twenty seeds was # and # and is # and #, that", MOVED[:4]),
    Text("of `sac` at 50,000 was # and is # (`target", MOVED[4:]),
    Table(
        f"evaluation return, IQM and 95% band | {SETTINGS} | {BEFORE} | {ALONE} | {DEFAULT}",
        returns,
    ),
    Table(
        "evaluation return, IQM and 95% band, ten seeds | hybrid_stochastic | its policy alone "
        "| settings=mbpo | sac | flash_sac",
        reported,
    ),
    Table(
        "evaluation return, IQM and 95% band, five seeds | hybrid_stochastic | its policy alone "
        "| settings=mbpo | nn_mppi | sac",
        reported,
    ),
    Table(
        "full method | mean | lowest seed | highest seed | DHMBPO, one update | two updates",
        compared,
    ),
    Text(
        "At 100,000 the mean is #, the IQM #, and DHMBPO's mean is 11,177",
        [
            float(hybrid("half-cheetah").seeds(100_000).mean()),
            hybrid("half-cheetah").at(100_000)[0],
        ],
    ),
    Text(
        "the lowest has # at 50,000. [Sixty-four",
        [float(hybrid("half-cheetah").seeds(50_000).min())],
    ),
    Text(
        "IQM # at 50,000 and # at 85,000 on an H100, # and # on another H200, where it has # at "
        "95,000; these runs have # at 50,000 and # at 90,000",
        [
            *(one.at(step)[0] for one in EARLIER for step in (50_000, 85_000)),
            EARLIER[1].at(95_000)[0],
            *(hybrid("half-cheetah").at(step)[0] for step in (50_000, 90_000)),
        ],
    ),
    Text(
        "(# at 30,000 and # at 50,000). Seed",
        [float(hybrid("hopper").seeds(step).mean()) for step in (30_000, 50_000)],
    ),
    Text(
        "at 50,000 the lowest has # and the next #",
        sorted(map(float, hybrid("hopper").seeds(50_000)))[:2],
    ),
    Text("stopped at 20,000 with # there, these have #:", both_times("hopper")),
    Text("Its first runs had # at 20,000, these have #.", both_times("ant")),
    Text(
        "# m/s at 30,000 and # m/s at 70,000",
        [curve("hybrid_walker_speed", "hybrid_stochastic").at(x)[0] for x in (30_000, 70_000)],
    ),
    Text(
        "it has an IQM of # at 100,000.",
        curve("velocity_walker2d", "all velocities").at(100_000)[:1],
    ),
    Table(
        "half-cheetah, four seeds | mean return | lowest seed | highest seed | DHMBPO, two updates",
        longer,
        plain=("DHMBPO, two updates",),
    ),
    Text("It took # s and # s from", [one["wall_s"] for one in LONG_TIMES]),
    Text("the end, # s of which compiling.\n\n| half-cheetah, four", [LONG_TIMES[0]["compile_s"]]),
    Text(
        "mean is # at 100,000, # at 160,000, # at 200,000 and # at 220,000",
        [float(FIRST.seeds(step).mean()) for step in (100_000, 160_000, 200_000, 220_000)],
    ),
    Text(
        "to # at 80,000 and to # at 200,000, and had",
        [float(FIRST.seeds(step)[0]) for step in (80_000, 200_000)],
    ),
    Text(
        "The mean over the five seeds is # at 20,000 and # at 30,000; "
        "with a discount of 0.99 it is # at 20,000, # at 30,000 and # at 40,000",
        [
            *means("half-cheetah", SETTINGS, 20_000, 30_000),
            *means("half-cheetah", BEFORE, 20_000, 30_000, 40_000),
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
    *default.CITED,
    *fast.CITED,
    *light.CITED,
    *layer_norm.CITED,
    Text("it was no faster, #.", [SPEED["loops in CUDA graphs"]["decisions_per_s"]]),
    Text(
        "The first runs of seeds 100 to 109 made #, on",
        [SPEED["half-cheetah, reported seeds"]["decisions_per_s"]],
    ),
    Text(
        "# decisions after # s, # s of which compiling",
        [SPEED["half-cheetah, reported seeds"][key] for key in ("step", "wall_s", "compile_s")],
    ),
    Text(
        "ten half-cheetahs made # decisions/s beside two programs of five walkers each, with # and "
        "#: # together",
        [*BESIDE, sum(BESIDE)],
    ),
    Table("half-cheetah | plain | per unit of variance | variance", signal),
]
PLAIN = [
    "at 20,000 and 50,000 decisions of the half-cheetah the IQM of",
    "of `sac` at 50,000 was",
    "Until 0.2 the target averaged",
    # settings, and where the text points at a decision
    "within 20 decisions",
    "are random (`policy_learner.early`): 5,000 random decisions on the walking robots, 1,000 on",
    "first temperature is 0.1",
    "The discount is 0.995",
    "Seeds 100 to 109, TF32, on an",
    "a time limit stopped it at 70,000)",
    "Seeds 100 to 109, one H100",
    "on seeds 200 to 204 of",
    "`sac`: seeds 0 to 9",
    "baseline: seeds 100 to 109, TF32",
    "and at 100,000 the bands do not overlap; `flash_sac` has less after 100,000 decisions",
    "than the hybrid after 40,000. On the hopper",
    "has less after 50,000 than the hybrid after 20,000; there the bands overlap at 50,000",
    "on the walker: seeds 100 to 109",
    "published curve at 20,000, 30,000 and 50,000",
    "at 50,000 ahead",
    "At 100,000 the mean",
    "at 30,000 and",
    "at 50,000). Seed",
    "at 85,000 on an H100",
    "at 95,000;",
    "at 90,000 (`hybrid",
    "at 70,000; `flash_sac` is as good by 80,000",
    "at 100,000.\n* **Ant",
    "Seeds 100 to 103, two in each",
    "At 400,000 decisions ahead",
    "At 200,000 they are level",
    "seeds 100, 101 and 102",
    "after 237,000 decisions by a time limit. They evaluated every 20,000 decisions",
    "at 100,000, ",
    "at 160,000,",
    "at 200,000 and",
    "at 220,000. Seed 100 lost",
    "at 80,000 and to",
    "at 200,000, and had it back",
    "The first runs of seeds 100 to 109",
    "at 50,000 and",
    "DHMBPO's mean is 11,177",
    "gait of about 2,000 that",
    "at 50,000. [Sixty-four",
    "Seed 104 has less than 2,500 in six of the eight evaluations from 15,000 on",
    "two; at 50,000 the lowest",
    "above 3,000 by the interquartile mean from 15,000 decisions",
    "on an H100 with other rounding, stopped at 20,000 with",
    "behind DHMBPO at 50,000**",
    "(9,691)",
    "more than 5,000, two have less than 2,100",
    "at 20,000, these have",
    "Seeds 100 to 104, two shared cores",
    "at 3,000 decisions, of which 1,000 are random. The others: seeds 0 to 9",
    "at 2,000 decisions, ahead",
    "Seeds 200 to 204, on which",
    "(seeds 200 to 209)",
    "at 20,000 and",
    "at 30,000; with a discount of 0.99 it is",
    "at 20,000, 9",
    "at 30,000 and 9",
    "at 40,000.",
    "at 20,000 decisions; at 30,000 the mean",
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
    "over seeds 100 to 109:",
    "Ten learners to 100,000 decisions within 8 minutes, the aim, need about 2,400",
    *default.PLAIN,
    *fast.PLAIN,
    *light.PLAIN,
    *layer_norm.PLAIN,
    # what others published
    "Gymnasium's version 4",
    # read from the console; the page says so
    "made 1,427 on an H200",
]
