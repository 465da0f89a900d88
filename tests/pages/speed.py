"""docs/results/speed.md."""

from typing import Any

from pages.cited import Table, Text
from pages.values import Curve, ahead, curve, p_value, read, significant, spread

PAGE = "docs/results/speed.md"
LOOP = "hybrid_stochastic"
RUNS = {
    "one H200, 64 seeds, highest": "seeds_64",
    "one H200, 64 seeds, default": "seeds_64_tf32",
    "two cores, 5 seeds": "seeds_5_two_cores",
}
ARMS = {"Sawyer": "sawyer_push", "Panda": "panda_stack", "half-cheetah": "halfcheetah"}
PLANS = {
    "reward of one layer; default": "hybrid_stochastic, K 20, T 10, default, one-layer reward",
    "reward of two layers, the thesis'; default": "hybrid_stochastic, K 20, T 10, default",
    "the same, highest": "hybrid_stochastic, K 20, T 10, highest",
}


def rows(part: str, what: str, has: str = "") -> dict[str, dict[str, Any]]:
    """Rows by name of the table so named; `has`: one of its rows."""
    (one,) = (
        table["rows"]
        for table in read("speed_h200")["tables"]
        if (table["part"], table["what"]) == (part, what)
        and any(has in row["name"] for row in table["rows"])
    )
    return {row["name"]: row for row in one}


def loop(label: str, column: str) -> list[float]:
    """The whole loop: decisions/s, or [MB] per learner."""
    key = "memory" if column.startswith("memory") else "rate"
    count = "4,096" if column.startswith("memory") else column
    if label.endswith("64 cores") or label.startswith("the same"):
        table = rows("loop", f"{LOOP}, native, default, one GPU, 64 cores")
        row = table["512 learners" if label.endswith("64 cores") else "512, prototype's work"]
    else:
        physics, precision = label.lower().split(", ")
        row = rows("loop", f"{LOOP}, {precision}")[f"{count} learners, {physics}"]
    return [row[key] / (1e6 if key == "memory" else 1)]


def gpus(label: str, column: str) -> list[float]:
    """Several GPUs."""
    table = rows("loop", f"{LOOP}, native, default, 16 cores a GPU")
    (row,) = (row for name, row in table.items() if name.startswith(f"{column} GPU"))
    return [row["ratio"] if label.startswith("times") else row["rate"]]


def physics(label: str, column: str) -> list[float]:
    """Bare and ours: "half-cheetah, 64 worlds, native (8 cores)"."""
    task, worlds, how = label.split(", ")[:3]
    bare, ours = {
        "Warp": ("bare mjx.step, Warp", "ours, warp"),
        "MJX": ("bare mjx.step", "ours, mjx"),
        "native (8 cores)": ("bare mujoco.rollout", "ours, native"),
    }[how]
    table = rows("physics", f"{task.replace('-', '')}, {worlds}", ours)
    rate = {"bare loop": table[bare]["rate"], "ours": table[ours]["rate"]}
    return [rate.get(column, rate["ours"] / rate["bare loop"])]


def arms(label: str, column: str) -> list[float]:
    """Bare and ours on one core: "Sawyer, 64 worlds"."""
    robot, worlds = label.split(", ")
    (table,) = (
        each["rows"]
        for each in read("speed_arms")["tables"]
        if each["what"] == f"{ARMS[robot]}, {worlds}"
    )
    bare, ours = (row["rate"] for row in table)
    return [{"bare loop": bare, "ours": ours}.get(column, ours / bare)]


def arms_on_h200(label: str, column: str) -> list[float]:
    """A cell of the table of the arms on an H200."""
    robot, worlds = label.split(", ")
    name = {
        "bare loop, MuJoCo C": "bare mujoco.rollout",
        "ours, MuJoCo C": "ours, native",
        "bare loop, Warp": "bare mjx.step, Warp",
        "ours, Warp": "ours, warp",
        "bare loop, MJX": "bare mjx.step",
        "ours, MJX": "ours, mjx",
    }[column]
    return [
        row["rate"]
        for table in read("speed_arms")["h200"]["tables"]
        for row in table["rows"]
        if table["what"] == f"{ARMS[robot]}, {worlds}" and row["name"] == name
    ]


def plan(label: str, column: str) -> list[float]:
    """Model steps per second: three digits, or in millions."""
    learners = f"{column.removesuffix(' learner')} learners"
    if label.startswith("MPPI"):
        return [
            significant(
                rows("plan", PLANS["reward of one layer; default"])["MPPI on the true model"][
                    "rate"
                ],
                2,
            )
        ]
    rate = rows("plan", PLANS[label])[learners]["rate"]
    return [rate / 1e6 if rate > 1e8 else significant(rate, 3)]


def latency(label: str, column: str) -> list[float]:
    """Median time [us] of a call."""
    return [read("latency")["rows"][f"{label}, {column}"]["median_us"]]


def seeds(label: str, column: str) -> list[float]:
    """The end of runs of 64 and of 5 seeds."""
    return curve(RUNS[label], column).at(40_000)


def ends(name: str, count: int = 64) -> list:
    """What the hybrid's and SAC's first seeds have at the end."""
    return [curve(name, label).seeds(40_000)[:count] for label in (LOOP, "sac")]


def span(name: str) -> list[float]:
    """Lowest and highest of five seeds, of the hybrid and of SAC."""
    return [x for each in ends(name, 5) for x in (each.min(), each.max())]


def area(name: str, label: str = LOOP):
    """[S] of a line."""
    line: Curve = curve(name, label)
    return line.area()


NATIVE = rows("loop", f"{LOOP}, default")
WIDE = rows("loop", f"{LOOP}, native, default, one GPU, 64 cores")
TEN = rows("plan", "hybrid_stochastic, K 16,384, T 32, thesis' reward")
TF32 = TEN["1 learners, default"]["rate"], TEN["1 learners, highest"]["rate"]
TRUE = rows("plan", PLANS["reward of one layer; default"])
FLOAT, LOW = ends("seeds_64"), ends("seeds_64_tf32")
BEFORE = [curve("fig_3_2_halfcheetah", label).at(40_000)[0] for label in (LOOP, "sac")]
BARE_MJX = rows("physics", "halfcheetah, 65,536 worlds", "ours, mjx")
SETTINGS = read("speed_arms")["settings"]["robots"]
MJX_PANDAS = arms_on_h200("Panda, 64 worlds", "ours, MJX")[0]
CITED = [
    Table("learners | 1 | 64 | 512 | 4,096 | memory per learner", loop),
    Text(
        "One learner reaches # times the aim of 400, 64 reach # times the aim of 20,000",
        [NATIVE["1 learners, native"]["rate"] / 400, NATIVE["64 learners, native"]["rate"] / 2e4],
    ),
    Text(
        "by #% at the work that the aim was set for, by #% at ours",
        [100 - WIDE[name]["rate"] / 1e3 for name in ("512, prototype's work", "512 learners")],
    ),
    Table("GPUs, 512 learners and 16 cores each, native | 1 | 2 | 4", gpus),
    Table(" | bare loop | ours | ratio", physics),
    Table("one core | bare loop | ours | ratio", arms),
    Table(
        "changed setting | Sawyer | Panda",
        lambda label, column: [SETTINGS[column][label]["ratio"]],
    ),
    Text(
        "differ from those of the short one by up to # and # m or rad",
        [SETTINGS[robot]["twice the time step"]["difference_max"] for robot in ("Sawyer", "Panda")],
    ),
    Text(
        "Euler's integrator, # times as fast with the Sawyer, differs by up to # and #.",
        [
            SETTINGS["Sawyer"]["integrator Euler"]["ratio"],
            *(
                SETTINGS[robot]["integrator Euler"]["difference_max"]
                for robot in ("Sawyer", "Panda")
            ),
        ],
    ),
    Table(
        "one H200 | bare loop, MuJoCo C | ours, MuJoCo C | bare loop, Warp | ours, Warp",
        arms_on_h200,
    ),
    Text(
        "# times for the Sawyer and # times for the Panda",
        [
            arms_on_h200(f"{robot}, 1,024 worlds", "ours, Warp")[0]
            / arms_on_h200(f"{robot}, 1,024 worlds", "ours, MuJoCo C")[0]
            for robot in ("Sawyer", "Panda")
        ],
    ),
    Text(
        "64 Pandas make # steps per second, # times a bare MJX loop",
        [
            MJX_PANDAS,
            MJX_PANDAS / arms_on_h200("Panda, 64 worlds", "bare loop, MJX")[0],
        ],
    ),
    Text(
        "ours is at # of the bare loop",
        physics("half-cheetah, 64 worlds, native (8 cores)", "ratio"),
    ),
    Text("three times the # M of the bare loop here", [BARE_MJX["bare mjx.step"]["rate"] / 1e6]),
    Text("So # shows that", physics("half-cheetah, 65,536 worlds, MJX", "ratio")),
    Text("The hopper's ratio of # overstates", physics("hopper, 65,536 worlds, MJX", "ratio")),
    Table("model steps per second | 1 learner | 512 | 4,096", plan),
    Text(
        "so # M are # TFLOP/s",
        [TRUE["4,096 learners"]["rate"] / 1e6, TRUE["4,096 learners"]["rate"] * 37e3 / 1e12],
    ),
    Text(
        "# M model steps per second, # ms per plan (float32: # M, # ms)",
        [x for rate in TF32 for x in (rate / 1e6, 16384 * 32 / rate * 1e3)],
    ),
    Text(
        "is # times as fast as the true one",
        [TRUE["1 learners"]["rate"] / TRUE["MPPI on the true model"]["rate"]],
    ),
    Table("time of an action [us] | light | default | mbpo", latency),
    Table("evaluation return at 40,000, IQM and 95% band | hybrid_stochastic | sac", seeds),
    Text("SAC in #% [#, #] of pairs", ahead(area("seeds_64"), area("seeds_64", "sac"))),
    Text(
        "end at # to # (SAC # to #), the same five on the GPU at # to # (# to #)",
        [*span("seeds_5_two_cores"), *span("seeds_64")],
    ),
    Text(
        "ended at an IQM of # (SAC #) before, # (#) after, # (#) in TF32",
        [
            *BEFORE,
            *(spread(each)[0] for name in ("seeds_64", "seeds_64_tf32") for each in ends(name, 10)),
        ],
    ),
    Text(
        "IQM goes from # to # (Mann-Whitney p #), SAC's from # to # (p #)",
        [
            x
            for before, after in zip(FLOAT, LOW, strict=True)
            for x in (spread(before)[0], spread(after)[0], p_value(before, after))
        ],
    ),
    Text(
        "float32 in #% [#, #] of pairs for the hybrid and in #% [#, #] for SAC",
        [
            x
            for label in (LOOP, "sac")
            for x in ahead(area("seeds_64_tf32", label), area("seeds_64", label))
        ],
    ),
]
PLAIN = [
    "runs of 300 random decisions",
    # settings
    "A decision of an arm has 20 steps",
    "One H200 and 16 cores of its host, physics steps",
    "Warp a program",
    "**16 cores are ahead of Warp with 64 worlds, Warp with 1,024**",
    "up to 40 worlds per core, 640 here",
    "A bare loop of 64 worlds on one core",
    "(8 iterations, `implicitfast`, pyramidal cones, 0.005 s; 2 and 7 explicit pairs",
    "After 2 s the positions",
    "64 Pandas make",
    "64 Sawyers did not finish compiling in 15 minutes",
    "With 64 worlds and more the arms",
    # read from the console; the page says so
    "5,682 steps per second with one Sawyer and 21,475 with 64, and 2,448 with one Panda",
    ": 0.03 to 0.16 of MuJoCo C",
    "with 6 to 16 cores of its host",
    "jax 0.11.2, MuJoCo 3.17.0, warp-lang 1.18.0",
    "a plan of K 20 and T 10",
    "batch 128",
    "up to 40 worlds per core",
    "at 65,536 worlds except",
    "with 64 worlds on MuJoCo C",
    "up to 100 solver iterations",
    "K 20, T 10; every plan",
    "A model step is 37 kFLOP",
    "for only 20 candidates",
    "One learner with K 16,384 and T 32",
    "seeds 0 to 9 ended",
    "median of 2,000 calls",
    "the 99th percentiles",
    "takes 50 ms",
    "So 64 seeds show",
    # aims
    "the aim of 400, 64 reach",
    "the aim of 20,000. **512 learners miss the aim of 100,000**",
    "where the aim was 600",
    "* 90% is reached",
    "The aim of 600 M is missed",
    "the aim of 1.2 ms is missed",
    # measured elsewhere, or read from the console; the page says so
    "On a shared 2-core Xeon one learner makes about 210 decisions/s",
    "with 4 iterations, had 4.46 M steps per second",
]
