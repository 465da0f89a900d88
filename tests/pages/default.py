"""docs/results/lookahead.md: 64 seeds of the default, its parts taken away, speed on an H200."""

from pages.cited import Table, Text
from pages.values import ahead, curve, number, parts, read

SPEED, MANY, FIVE = (read("lookahead_speed")[key] for key in ("h200", "many", "five_programs"))
SEEDS = curve("hybrid_many", "hybrid_stochastic")
EARLIER = curve("hybrid_many", "an earlier run")
LOWEST = SEEDS.seeds(50_000).argsort()[:2]  # of the seeds from 100 on


def one(seed: int, *steps: int) -> list[float]:
    """Returns of one of the 64 seeds."""
    return [float(SEEDS.seeds(step)[seed - 100]) for step in steps]


def many(label: str, column: str) -> list[float]:
    """A cell of the table of 64 seeds."""
    each = SEEDS.seeds(number(label))
    if column == "mean":
        return [float(each.mean())]
    if column == "lowest seed":
        return [float(each.min())]
    return [float((each < 2_500).sum())] if "below" in column else SEEDS.at(number(label))


def speed(label: str, column: str) -> list[float]:
    """A cell of the table of learners on an H200."""
    return [SPEED["default"][label]["memory_MB" if "memory" in column else "decisions_per_s"]]


CITED = [
    Table(
        "half-cheetah, 64 seeds | IQM and 95% band | mean | lowest seed | seeds below 2,500", many
    ),
    Text("slow at first (# at 10,000, # at 50,000)", one(114, 10_000, 50_000)),
    Text("at 20,000 (#) and has # at 50,000.", one(150, 20_000, 50_000)),
    Text(
        "The lowest two at 50,000, # and #, had # and # at 30,000",
        [float(SEEDS.seeds(step)[seed]) for step in (50_000, 30_000) for seed in LOWEST],
    ),
    Text(
        "It took # s from the command to the end, # s of which compiling, evaluations included: # "
        "decisions/s",
        [
            MANY["wall_s"],
            MANY["compile_s"],
            MANY["learners"] * MANY["decisions"] / MANY["wall_s"],
        ],
    ),
    Text(
        "had # [#, #] at 40,000, the lowest #.",
        [*EARLIER.at(40_000), float(EARLIER.seeds(40_000).min())],
    ),
    Table(
        "default, one change | IQM and band, 10,000 | 20,000 | lowest seed, 20,000",
        parts("default_parts"),
    ),
    Text(
        "ahead of the default in #% [#, #] of pairs",
        ahead(
            *(
                curve("default_parts", label).seeds(20_000)
                for label in ("the policy alone", "the default")
            )
        ),
    ),
    Text(
        "one seed has # at 20,000.",
        [float(curve("default_parts", "discount 0.99").seeds(20_000).min())],
    ),
    Table("learners, H200 | decisions/s | memory per learner, MB", speed),
    Text("One program of ten makes # there", [SPEED["default"]["10"]["decisions_per_s"]]),
    Text(
        "minutes on the H100 and # on the H200",
        [(1e6 / SPEED["default"]["10"]["decisions_per_s"] + MANY["compile_s"]) / 60],
    ),
    Text(
        "are hardly faster: # together on an H100, after # s of compiling",
        [sum(FIVE["decisions_per_s"]), max(FIVE["compile_s"])],
    ),
    Text(
        "64 take # minutes to 50,000, # s each",
        [MANY["wall_s"] / 60, MANY["wall_s"] / MANY["learners"]],
    ),
]
PLAIN = [
    "Seeds 100 to 163 in one program",
    "None of 64 seeds is in the gait of about 2,000 from 30,000 decisions on",
    "Seed 114 was slow",
    "at 10,000, ",
    "at 50,000); seed 150",
    "did badly in its evaluation at 20,000",
    "at 50,000. The lowest two at 50,000",
    "at 30,000: they lost",
    "stopped at 49,000 by a time limit",
    "at 40,000, the lowest",
    "seeds 100 to 109, TF32, an H200 that four programs shared",
    "at 10,000 decisions. Without",
    "of the default's at 20,000",
    "at 20,000 decisions it is ahead of the default in",
    "the band at 10,000 decisions is below the default's; at 20,000 they overlap",
    "With a discount of 0.99 one seed",
    "at 20,000. The default has its discount",
    "One H200 and 16 processors",
    # read from the console; the page says so
    "made 255, 1,427, 3,280 and 3,611 on an H200",
    "are cheaper: 64 take",
    "minutes to 50,000",
]
