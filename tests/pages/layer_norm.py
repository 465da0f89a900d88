"""docs/results/lookahead.md: layer normalisation without a learned scale, and speed on a GPU."""

import numpy as np

from hybrid_rl.analysis.curves import iqm
from pages.cited import Table, Text
from pages.values import Curve, curve, number, read


def shifted(task: str, label: str = "layer_norm=shift") -> Curve:
    """A line of the pictures of layer normalisation without a learned scale."""
    return curve(f"shift_{task.replace('-', '')}", label)


def shift(label: str, column: str) -> list[float]:
    """A cell of the table of layer normalisation."""
    label_of = {"shift": "layer_norm=shift", "default": "default"}
    line = label_of.get(column, "layer_norm=shift, its policy alone")
    return shifted(label.split(",")[0], line).at(number(label))


def speed(label: str, column: str) -> list[float]:
    """A cell of the table of learners."""
    key = {"compilation [s]": "compile_s", "a round [ms]": "ms_per_round"}
    return [LEARNERS["default"][label][key.get(column, "decisions_per_s")]]


SPEED = read("lookahead_speed")["rows"]
LEARNERS, ROUND = (read("lookahead_speed")[key] for key in ("by_learners", "round"))
BFLOAT = "bfloat16, layer normalisation without scale and shift"
CHOICE = read("shift_choice")
LOST = int(shifted("half-cheetah").seeds(50_000).argmin())
CITED = [
    Table(
        "`layer_norm=shift`, IQM and 95% band | default | shift | shift, its policy alone", shift
    ),
    Text(
        "At 50,000 the mean is # and the lowest of ten seeds has #; DHMBPO",
        [float(f(shifted("hopper").seeds(50_000))) for f in (np.mean, np.min)],
    ),
    Text(
        "At 50,000 the mean is # instead of #, two thirds of the difference because of one seed "
        "whose policy had just lost its gait (#; it had # ten",
        [
            float(shifted("half-cheetah").seeds(50_000).mean()),
            float(shifted("half-cheetah", "default").seeds(50_000).mean()),
            float(shifted("half-cheetah").seeds(50_000).min()),
            float(shifted("half-cheetah").seeds(60_000)[LOST]),
        ],
    ),
    Text(
        "it is behind on both: # on the half-cheetah, # on the hopper (IQM), where the default has "
        "# and #.",
        [
            *(float(iqm(np.array(CHOICE[task]))) for task in ("halfcheetah", "hopper")),
            *(
                curve(f"lookahead_{task}", "today's default").at(20_000)[0]
                for task in ("halfcheetah", "hopper")
            ),
        ],
    ),
    Table("learners | decisions/s | compilation [s] | a round [ms]", speed),
    Text(
        "On the H100, a round of ten learners takes # ms: # in the world and the memory, # for "
        "two updates of the models, # for two of policy and critic, # for the planner",
        [LEARNERS["default"]["10"]["ms_per_round"], *ROUND["ms_of_ten_learners"].values()],
    ),
    Table(
        "learners | products of matrices | reductions | elementwise | rest | all kernels",
        lambda label, column: [ROUND["kernels_ms"][label][column]],
    ),
    Text(
        "A decision has # GFLOP, so 64 learners do # TFLOP/s",
        [
            ROUND["gflop_per_decision"],
            ROUND["gflop_per_decision"] * LEARNERS["default"]["64"]["decisions_per_s"] / 1000,
        ],
    ),
    Text(
        "With ten learners the # kernels of a round take # microseconds",
        [
            ROUND["kernels_ms"]["10"]["kernels"],
            1000 * ROUND["kernels_ms"]["10"]["all kernels"] / ROUND["kernels_ms"]["10"]["kernels"],
        ],
    ),
    Text(
        "`layer_norm=shift` makes # with ten learners and # with 64",
        [LEARNERS["layer_norm=shift"][n]["decisions_per_s"] for n in ("10", "64")],
    ),
    Text(
        "a trial that is not in the library, made # and #.",
        [LEARNERS[BFLOAT][n]["decisions_per_s"] for n in ("10", "64")],
    ),
    Text(
        "ten learners made # after # s of compilation, on another day when the default made # "
        "after # s",
        [
            SPEED[name][key]
            for name in ("without Triton's products", "autotuned")
            for key in ("decisions_per_s", "compile_s")
        ],
    ),
    Text(
        "they take # minutes on the H100",
        [
            (
                1e6 / LEARNERS["default"]["10"]["decisions_per_s"]
                + LEARNERS["default"]["10"]["compile_s"]
            )
            / 60
        ],
    ),
]
PLAIN = [
    "a time limit at 65,000 decisions",
    "At 50,000 the mean is",
    "and the lowest of ten seeds",
    "From 20,000 on the IQM stays above 3,000",
    "two of ten seeds had an evaluation below 2,800 at 40,000",
    "lost its gait",
    "200 to 204, at 20,000 decisions, it is behind",
    "has as much from 30,000 decisions on (first table)",
    "nothing else on its 16 processors",
    "so 64 learners do",
    "With 64 learners more than half",
    "more than 64 learners",
    "with 64. Activations",
    "DHMBPO has 3,375 at 30,000 and 3,500 at 50,000",
]
