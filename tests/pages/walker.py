"""docs/results/walker.md."""

from pages import lookahead, published
from pages.cited import Table, Text
from pages.values import Curve, curve, number, read

PAGE = "docs/results/walker.md"
ERROR = read("critic_error")["rows"]
SHARE = read("velocity_share")["rows"]
GAIT = read("walker_imagined")["gait"]
ANKLE = 5  # of the right leg, in qvel of the walker


def observed(label: str, column: str = "all velocities") -> Curve:
    """A line of the pictures of what is observed; the task is the first word of the label."""
    return curve(f"velocity_{label.split(',')[0]}", column)


def compared(label: str, column: str) -> list[float]:
    """A cell of the table of model-free learners."""
    name = "velocity_walker2d" if column.endswith("all velocities") else "hybrid_walker2d"
    return curve(name, column).at(number(label))


def mean(task: str, step: int) -> float:
    """Mean return over the seeds, with all velocities."""
    return float(observed(task).seeds(step).mean())


def speed(label: str, step: int) -> float:
    """Speed of the walker in training [m/s]."""
    return curve("hybrid_walker_speed", label).at(step)[0]


def lowest(column: str) -> float:
    """The return of the lowest of the hopper's seeds at 50,000 decisions."""
    return float(observed("hopper", column).seeds(50_000).min())


def imagined(label: str, column: str) -> list[float]:
    """A cell of the table of futures in the model and in the world."""
    source, what = column.split(", ")
    row = read("walker_imagined")["after"][str(round(number(label)))][source]
    return [100 * row["ended"][-1]] if what == "falls" else [row["reward"][-1]]


CITED = [
    Table(
        "IQM and 95% band, ten seeds | all velocities | all velocities, its policy alone "
        "| clipped to 10",
        lambda label, column: observed(label, column).at(number(label)),
    ),
    Table(
        "all velocities | mean | lowest seed | highest seed | DHMBPO, one update | two updates",
        lambda label, column: published.beside(observed(label), label, column),
    ),
    Text(
        "it has # at 70,000 decisions instead of #, at # m/s instead of # m/s, and # m/s at "
        "100,000",
        [
            observed("walker2d").at(70_000)[0],
            observed("walker2d", "clipped to 10").at(70_000)[0],
            speed("all velocities", 70_000),
            speed("hybrid_stochastic", 70_000),
            speed("all velocities", 100_000),
        ],
    ),
    Table(
        "IQM and 95% band, ten seeds | hybrid_stochastic | flash_sac | sac | sac, all velocities "
        "| flash_sac, all velocities | nn_mppi, all velocities",
        compared,
    ),
    Text(
        "`flash_sac` has # [#, #] at 100,000, the hybrid # [#, #]",
        [
            x
            for label in ("flash_sac, all velocities", "all velocities")
            for x in observed("walker2d", label).at(100_000)
        ],
    ),
    Text(
        "it has # [#, #] at 50,000 instead of # [#, #]",
        [
            *observed("walker2d", "flash_sac, all velocities").at(50_000),
            *lookahead.hybrid("walker2d", "flash_sac").at(50_000),
        ],
    ),
    Text(
        "does not walk at all**: # [#, #] at 100,000. On the hopper with all velocities it has "
        "# [#, #] there",
        [
            x
            for task in ("walker2d", "hopper")
            for x in observed(task, "nn_mppi, all velocities").at(100_000)
        ],
    ),
    Text(
        "the lowest of ten seeds has #, where it has # with clipped velocities",
        [lowest("all velocities"), lowest("clipped to 10")],
    ),
    Table(
        "the critic's error | 10,000 | 20,000 | 40,000",
        lambda label, column: [100 * ERROR[label][str(round(number(column)))]["relative"]],
    ),
    Text(
        "in #% of its decisions, mostly its right ankle (#%), which reaches # rad/s",
        [
            100 * SHARE["walker2d"]["any"],
            100 * SHARE["walker2d"]["joint"][ANKLE],
            SHARE["walker2d"]["most"][ANKLE],
        ],
    ),
    Text("(`policy=hopper`) has one in #%", [100 * SHARE["hopper"]["any"]]),
    Text(
        "seeds 300 to 304 have # [#, #] with all velocities and # [#, #] with clipped ones",
        [
            x
            for label in ("all velocities", "clipped to 10")
            for x in curve("velocity_light", label).at(60_000)
        ],
    ),
    Table(
        "walker2d, five seeds, IQM and 95% band | 20,000 | 30,000 | 40,000",
        lambda label, column: curve("velocity_settings", label).at(number(column)),
    ),
    Text(
        "# [#, #] at 20,000 and # [#, #] at 40,000.",
        [x for step in (20_000, 40_000) for x in lookahead.hybrid("walker2d").at(step)],
    ),
    Table(
        "walker2d, IQM and 95% band | 20,000 | 30,000 | 40,000",
        lambda label, column: curve("walker_faster", label).at(number(column)),
    ),
    Table(
        "walker2d, 25 decisions of the policy | world, falls | model, falls "
        "| world, reward per decision | model, reward per decision",
        imagined,
    ),
    Text(
        "in front for #% of the time, and at most # m in front but # m behind the other",
        [100 * GAIT["right_foot_in_front"], GAIT["most_in_front_m"], GAIT["most_behind_m"]],
    ),
    Text("It walks at # m/s", [GAIT["speed_m_per_s"]]),
    Text(
        "its rewards are #% to #% too high",
        sorted(
            100 * (imagined(row, "model, reward")[0] / imagined(row, "world, reward")[0] - 1)
            for row in ("after 100", "after 300")
        ),
    ),
    Text(
        "how-it-was-chosen) it had #",
        [lookahead.line("walker2d", lookahead.BEFORE).at(40_000)[0]],
    ),
    Text(
        "# on the half-cheetah and # on the hopper (target -1.5) at 30,000, "
        "where the default has # and #",
        [
            lookahead.line(task, label).at(30_000)[0]
            for labels in (
                ("target entropy -3", "target entropy -1.5"),
                (lookahead.SETTINGS, lookahead.SETTINGS),
            )
            for task, label in zip(("halfcheetah", "hopper"), labels, strict=True)
        ],
    ),
    Text(
        "A longer one, 0.998, has # [#, #] at 20,000",
        curve("walker_faster", "discount 0.998").at(20_000),
    ),
]
PLAIN = [
    "at 100,000, the hybrid",
    "After 100,000 decisions it has what the hybrid has after 50,000",
    "at 50,000 instead of",
    "at 90,000 the bands overlap. With clipped velocities",
    "last returns, at 70,000, by 90,000",
    "walks by 100,000, with",
    "at 100,000. On the hopper",
    "stopped at 96,000 by a time limit",
    "branches of 40 decisions instead of 20",
    "gains from 40 at 100,000 decisions (7,564 instead of 6,457 with one update); a time limit "
    "stopped ours at 40,000",
    # settings, and where the text points at a decision
    "observe to [-10, 10]",
    "seeds 100 to 109, TF32, on one",
    "a time limit stopped it at 70,000)",
    "at 70,000 decisions instead",
    "m/s at 100,000",
    "at 50,000 and 100,000 it is ahead",
    "8,158 at 100,000",
    "At 50,000 the lowest of ten seeds",
    "(`policy=walker2d`, 1.8 m/s) has a joint faster than 10 rad/s",
    "does not profit in 60,000 decisions**: seeds 300 to 304 have",
    "Seeds 200 to 204, one change each",
    "five critics of 512 units",
    "0.998 was stopped by a time limit after 8,000 decisions",
    "today's default, 40,000 decisions",
    "reported seeds 100 to 109",
    "at 20,000 and",
    "at 40,000.",
    "discount of 0.99 it has little more",
    "A longer one, 0.998",
    "at 20,000, no more",
    "only the last 15,000 decisions in memory",
    "Gymnasium's version 4 (friction 0.9 instead of 1.9)",
    "after 20,000 decisions it is ahead, after 30,000 behind",
    "(target -1.5) at 30,000",
    "(one run of 200,000 decisions, seed 300, one core of an AMD EPYC; its policy has 2,732)",
    "after 300, 312, 324, 336, 348 and 360 decisions",
]
