"""docs/results/chapter5.md."""

from typing import Any

import numpy as np

from pages.cited import Table, Text
from pages.contacts import (
    ALONE,
    ARRANGEMENTS,
    FIRST,
    MAPS,
    POSES,
    ROWS,
    SEVENTH,
    arranged,
    entropy,
    found,
    good,
    interval,
    learned,
    mapped,
    median_iou,
    one,
    over_time,
    poses,
    seventh,
    sixth,
    sooner,
    touched,
    waits,
)
from pages.values import read

PAGE = "docs/results/chapter5.md"
PATHS = "informative paths"
BEHIND = [-x for x in one(POSES, FIRST)["truth_behind"]["each"] if x < 0]
LEARNED_MAPS = [label for label in read(SEVENTH)["methods"] if "learned" in label]
ANGLES = [seventh(label, "angle")[0] for label in LEARNED_MAPS]
WRONG = [100 * x for x in interval(one("sprk", "accelerometer")["false"]["wrong"]["each"])]
SPEED = read("speed_contacts")
SHARED = SPEED["shared_h100"]
ON_MADE = ("MuJoCo, map made in MuJoCo", "MuJoCo, map of the formula", "map made in MuJoCo")
FOUND = [seventh(label, "found at 130 s")[0] for label in (*LEARNED_MAPS, *ON_MADE)]
OWN = one("sprk_57_own", "MuJoCo, map made in MuJoCo")
MORE = one("fig_5_6_wrong", "Fourier, 0.1 instead of 0.02")["false"]


def rate(trials: str, column: str) -> list[float]:
    """A cell of the table of speed."""
    tables = (SPEED["h100"] if "H100" in column else SPEED)["tables"]
    task = "ergodic_mapping" if "mapping" in column else "ergodic_localisation"
    (table,) = (table for table in tables if table["what"] == task)
    (row,) = (
        row
        for row in table["rows"]
        if row["name"] in (f"{trials} learner{s}, native" for s in ("", "s"))
    )
    return [row["rate"]]


def return_ratio(false: dict[str, Any]) -> float:
    """Time near false contacts over time elsewhere."""
    return interval(false["returned"]["each"])[0] / interval(false["elsewhere"]["each"])[0]


CITED = [
    Table(
        "trials in one program, decisions/s | mapping, two cores of an AMD EPYC"
        " | localising, the two cores, shared | mapping, one H100 | localising, one H100",
        rate,
    ),
    Text(
        "20 trials made # (mapping) and # (localising)",
        [SHARED["ergodic_mapping"], SHARED["ergodic_localisation"]],
    ),
    Text(
        "one trial made # to # decisions/s",
        [pick(SPEED["localising_shared_each"]) for pick in (min, max)],
    ),
    Table(
        "20 trials of 60 s | all 3 objects at 20 s | all 3 at 60 s | outline covered at 20 s"
        " | outline covered at 60 s | IoU at 20 s | IoU at 60 s | mean IoU over time"
        " | free cells visited | seconds until all are touched",
        mapped(MAPS, 60.0),
    ),
    Table(
        "rows of ergodic mapping | objects touched at 60 s | all 3 after 60 s"
        " | IoU at 60 seconds | mean IoU | cells",
        mapped(ROWS, 60.0),
    ),
    Table(
        "20 trials of 40 s | within 3 cm, 0.1 rad at 20 s | at 40 s | median position [m]"
        " | median angle [rad] | median seconds until found | never | stuck at the end"
        " | p of the times",
        poses(POSES, 20.0, 40.0),
    ),
    Table(
        "filters, 20 trials of 40 s | good at 20 s | good at 40 s | position [m] | angle [rad]",
        poses("fig_5_4_filters", 20.0, 40.0),
    ),
    Table(
        "Fourier unless named, 20 trials of 40 s | within 3 cm and 0.1 rad at 20 s"
        " | within both at 40 s | position error [m] | angle error [rad] | seconds until found",
        learned,
    ),
    Table(
        "20 trials of 120 s | all 3 objects at 60 s | IoU at 120 s | outline at 120 s"
        " | false contacts a trial | rejected | return | elsewhere",
        sixth,
    ),
    Table(
        "20 trials of 130 s | found at 40 s | found at 130 s | position at 130 s [m]"
        " | angle at 130 s [rad] | seconds until it is found",
        seventh,
    ),
    Table(
        "entropy of the pose [nat] | after 10 s | after 40 s",
        entropy,
    ),
    Table(f"mean IoU over 60 s | {' | '.join(ARRANGEMENTS)}", arranged),
    Text(
        "in # (Fourier) and # (KL) of 20 trials, median IoU # and #",
        [
            *(touched(MAPS, label, 60)[0] for label in ("Fourier", "KL")),
            *(median_iou(label) for label in ("Fourier", "KL")),
        ],
    ),
    Text(
        "EER touches one object in # of 20 trials",
        [sum(row[-1] == 1 for row in one(MAPS, "entropy")["objects"]["each"])],
    ),
    Text("KL finds the pose in # of 20 trials", [good(POSES, "KL trace")]),
    Text("Fourier with the trace has #: in the", [good(POSES, FIRST)]),
    Text("the log-likelihood is # to # nat below", [min(BEHIND), max(BEHIND)]),
    Text(
        "and `mutual`, it has # of 20", [good("fig_5_4_filters", "Fourier mutual, 3,000 particles")]
    ),
    Text(
        "is good here**: # and # of 20",
        [good(POSES, "Fourier, coverage"), good(POSES, "KL, coverage")],
    ),
    Text("sooner than EER (p #)", found(POSES, "entropy", "p of", 20, 40)),
    Text("one position in # of 20 trials only", found(POSES, "entropy", "stuck", 20, 40)),
    Text(
        "every 5 decisions, in # of 20",
        found(POSES, "entropy along the way, every 5, 1,000 samples", "stuck", 20, 40),
    ),
    Text("EER improves too, to # of 20", [good("fig_5_4_filters", "entropy, 3,000 particles")]),
    Text(
        "alone # of 20 are found at 40 s, with the printed step #, with both #; five cosines a "
        "side do as well as eight, #",
        [
            good("fig_5_4_steps", label)
            for label in ("forget 0", "printed step", "printed step, forget 0", "5 modes")
        ],
    ),
    Text(
        "Informative paths find the pose in # of 20 trials, sooner than EER in # and sooner than "
        "Fourier with the trace in # (p #)",
        [
            good(POSES, PATHS),
            sooner(waits(ALONE[PATHS], PATHS), waits(POSES, "entropy"))[0],
            *sooner(waits(ALONE[PATHS], PATHS), waits(POSES, FIRST)),
        ],
    ),
    Text("# [#, #]% of its readings are wrong", WRONG),
    Text("# [#, #]% of all readings are wrong", [100 * x for x in interval(MORE["wrong"]["each"])]),
    Text(
        "returns only # and # times as often",
        [return_ratio(MORE), return_ratio(one("sprk", "accelerometer")["false"])],
    ),
    Text("on each map: # to # of 20 trials", [min(FOUND), max(FOUND)]),
    Text("on its own map has #;", seventh("MuJoCo, map made in MuJoCo", "found at 130 s")),
    Text(
        "it is # rad in MuJoCo and # rad with the formula",
        [seventh(f"{world}map made in MuJoCo", "angle")[0] for world in ("MuJoCo, ", "")],
    ),
    Text("the same sign in # of 20 trials", [sum(x < 0 for x in OWN["signed_angle"])]),
    Text("between # and # rad", [min(ANGLES), max(ANGLES)]),
    Text(
        "contacts alone in # trials of 20",
        [read("absence")["absences_leave_no_more"][-1]],
    ),
]
LOST = [
    over_time("sprk", "touch sensor", "iou", 120.0)[0]
    - over_time("sprk", "accelerometer", "iou", 120.0)[0]
]
ARM = one("sawyer_probe", "ergodic_mapping")
CITED.append(
    Text(
        "in # of 4 trials, after # s in the median, IoU # [#, #] at 60 s",
        [
            sum(row[-1] == 3 for row in ARM["objects"]["each"]),
            float(np.median(ARM["seconds_to_all"]["each"])),
            *over_time("sawyer_probe", "ergodic_mapping", "iou", 60.0),
        ],
    )
)
CITED.append(Text("and # of IoU with the accelerometer's errors", LOST))
PLAIN = [
    "40 decisions with\ncontacts",
    "Seeds 100 to 103, which",
    "of 4 trials, after",
    "s in the median, IoU",
    "at 60 s\n([sawyer",
    "programs shared, 20 trials",
    "a resolution of 3 mm, at least -11.5 nat",
    "trials of 20",
    "p = 1/2, and the ergodic robots",
    "With 0.1 instead of 0.02",
    "five (0.1) and eight times",
    "of 20 trials at 130 s",
    "20 trials (seeds 0\nto 19",
    "Settings were chosen on seeds 100 to 105",
    "float32, jax 0.11",
    "up to 18 runs shared them, and 20 trials of 60 s took 26 s to 38 s",
    "objects in 20 s, ergodic mapping more",
    "finds half of the poses in 40 s",
    "after 120 s, suffices",
    "2.3 cm and 0.003 rad after 130 s",
    "ends 2.3 cm and 0.003 rad",
    "200 candidates, a new goal\nevery 20 decisions",
    "lies within 5 cm of a contact",
    "p > 1/2",
    "divided by 60 s",
    "IQM and 95% band for the rest",
    "All three objects at 60 s",
    "(the aim was 18 of 20 and 0.8)",
    "p (1 - p)",
    "in the target, 0.3 elsewhere",
    "gain 1 / (2 R dt)",
    "(share 0)",
    "moved by up to 10 cm",
    "within 3 cm and 0.1 rad to the end of the trial. 1,000 particles",
    "the last 10 s in one cell of 10 cm",
    "or with 3,000 particles, 8 moves",
    "IoU at 60 s and its mean",
    "half of the trials at 40 s",
    "goals by the entropy along the way, every 5",
    "learned in 60 s: of the first three trials of seeds 100 to 102",
    "2% of the readings are wrong",
    "3,000 particles and 8 moves were chosen",
    "17 of 18 trials, against 10",
    "seeds 100 to 105 and three maps",
    "19 of 20 on the known map and 18 of 20 on a learned one with 2% of the readings wrong",
    "the third has 17",
    "ball of 3.65 cm",
    "falsely 1 with probability 0.02 |u - u_before| / 2",
    "p < 1/2 at the end. Return: time within 5 cm",
    "a lag of 10 ms",
    "(0.5, 0.6, -1.1)",
    "on seeds 100 to 102. The default",
    "below 1 cm on every map",
    "draws with seeds 1, 2 and 3",
    "40 cm x 50 cm",
    "has 60 s in 13 s",
    "(5 cm, 3 cm)",
    "(KL) of 20 trials",
    "of 20 trials, whichever",
    "of 20 trials, by either",
    "of 20. * Informative",
    "of 20 trials, sooner",
    "of 20 trials: this map",
    "of 20 (next table)",
    "of 20. Information",
    "of 20 trials only",
    "of 20. The controller",
    "of 20 are found at 40 s",
]
