"""docs/results/chapter3.md."""

from collections.abc import Sequence

import numpy as np

from pages import hopper
from pages.cited import Table, Text
from pages.values import Curve, ahead, areas, curve, number, p_value, returns, spread

PAGE = "docs/results/chapter3.md"
TASKS = ("half-cheetah", "hopper", "cartpole", "pendulum")
THESIS = {task: f"fig_3_2_{task.replace('-', '')}" for task in TASKS}
ADJOINT = {task: f"fig_3_1_{task.replace('-', '')}" for task in TASKS}
DEFAULTS = {task: f"defaults_{task.replace('-', '')}" for task in TASKS} | {
    "cartpole, dm_control's reward": "defaults_cartpole_dm"
}
HYBRID, DETERMINISTIC = "hybrid_stochastic", "hybrid_deterministic"
SIGNAL = "planner/mode_insertion_gradient"


def default(task: str, label: str = HYBRID) -> Curve:
    """A line of a picture of defaults."""
    return curve(DEFAULTS[task], label)


def thesis(task: str, label: str) -> Curve:
    """A line of figure 3-2."""
    return curve(THESIS[task], label)


def alone(task: str, half: str, label: str = HYBRID) -> Curve:
    """A line of figure 3-4; half: policy or planner."""
    return curve(f"fig_3_4_{task.replace('-', '')}_{half}", label)


def adjoint(task: str, label: str) -> Curve:
    """A line of figure 3-1; where it has no SAC, that of figure 3-2."""
    if label == "sac" and task in ("half-cheetah", "hopper"):
        return thesis(task, label)
    return curve(ADJOINT[task], label, "eval/return")


def deterministic_returns(label: str, column: str) -> list[float]:
    """A cell of figure 3-1's first table."""
    return adjoint(label.split(",")[0], column).at(number(label))


def deterministic_areas(label: str, column: str) -> list[float]:
    """A cell of figure 3-1's second table."""
    task, against = label.split(",")[0], column.removeprefix("ahead of ")
    theirs = adjoint(task, against).area(number(label))
    if against == column:
        return spread(theirs)
    return ahead(adjoint(task, DETERMINISTIC).area(number(label)), theirs)


def agreement(header: str, metric: str, after: str) -> Table:
    """A table of the agreement signal, plain or per unit of the policy's variance."""

    def values(label: str, column: str) -> list[float]:
        line = curve(ADJOINT[label], DETERMINISTIC, metric)
        first, last, top = line.x[0], line.x[-1], line.x[line.iqm.argmax()]
        return {
            "first row": [*line.at(first), first],
            "highest": [line.at(top)[0], top],
            "last": [*line.at(last), last],
            "highest over last": [line.at(top)[0] / line.at(last)[0]],
            "last over first": [line.at(last)[0] / line.at(first)[0]],
        }[column]

    return Table(header, values, after)


def ratio_of_means(task: str) -> list[float]:
    """Agreement signal over the policy's variance, each its IQM, in the first row and the last."""
    lines = [
        curve(ADJOINT[task], DETERMINISTIC, name) for name in (SIGNAL, "planner/policy_variance")
    ]
    return [float(lines[0].iqm[i] / lines[1].iqm[i]) for i in (0, -1)]


def side_by_side(header: str, files: dict[str, str | None]) -> Table:
    """Several settings of `hybrid_stochastic`, a column each; None: the defaults' files."""

    def values(label: str, column: str) -> Sequence[float]:
        task, name = label.split(",")[0], files[column]
        if name is None:
            return default(task).at(number(label))
        return curve(name, HYBRID, task=task.replace("-", "")).at(number(label))

    return Table(header, values)


def passes(line: Curve, threshold: float) -> list[float]:
    """The last evaluation before the IQM first reaches the threshold, and that one."""
    i = int(np.argmax(line.iqm >= threshold))
    return [line.x[i - 1], line.x[i]]


def passed(line: Curve, threshold: float, by: float) -> int:
    """How many seeds had reached the threshold at any evaluation until then."""
    return int((line.each[:, line.x <= by] >= threshold).any(1).sum())


CHEETAH, HOPPER, DM = (
    default("half-cheetah"),
    default("hopper"),
    default("cartpole, dm_control's reward"),
)
PENDULUM = adjoint("pendulum", DETERMINISTIC)
PENDULUM_SIGNAL = curve(ADJOINT["pendulum"], DETERMINISTIC, SIGNAL)
BAND = "evaluation return, IQM and 95% band"
END = np.sort(np.delete(CHEETAH.seeds(100_000), 2))
AREAS = " | hybrid_stochastic | nn_mppi | sac | ahead of nn_mppi | ahead of sac"
DETERMINISTIC_AREAS = (
    " | hybrid_deterministic | deterministic_mpc | one_step_mpc | sac | ahead of deterministic_mpc"
    " | ahead of one_step_mpc | ahead of sac"
)
CITED = [
    returns(
        f"{BAND} | hybrid_stochastic | nn_mppi | sac (same small networks)",
        THESIS,
        {"sac (same small networks)": "sac"},
    ),
    areas(AREAS, THESIS, HYBRID, after="Area under the evaluation curve"),
    Text(
        "policy alone has # where a policy trained alone has #",
        [
            alone("cartpole", "policy").at(8_000)[0],
            alone("cartpole", "policy", "sac").at(8_000)[0],
        ],
    ),
    Text(
        "neither part alone (policy #, planner #) is better than the method trained alone (#, #); "
        "together they have #",
        [
            alone("half-cheetah", "policy").at(40_000)[0],
            alone("half-cheetah", "planner").at(40_000)[0],
            alone("half-cheetah", "policy", "sac").at(40_000)[0],
            alone("half-cheetah", "planner", "nn_mppi").at(40_000)[0],
            thesis("half-cheetah", HYBRID).at(40_000)[0],
        ],
    ),
    Text(
        "the policy alone (#) is as good as both together (#)",
        [alone("hopper", "policy").at(48_000)[0], thesis("hopper", HYBRID).at(48_000)[0]],
    ),
    Table(
        f"{BAND} | hybrid_deterministic | deterministic_mpc | one_step_mpc | sac",
        deterministic_returns,
    ),
    Table(DETERMINISTIC_AREAS, deterministic_areas),
    Text(
        "in #% [#, #] of pairs of seeds at 24,000",
        ahead(
            adjoint("hopper", DETERMINISTIC).seeds(24_000),
            adjoint("hopper", "deterministic_mpc").seeds(24_000),
        ),
    ),
    Text(
        "hybrid in #% [#, #] of pairs)",
        ahead(PENDULUM.seeds(6_000), adjoint("pendulum", "sac").seeds(6_000)),
    ),
    Text(
        "the hybrid is best at # (# [#, #])",
        [PENDULUM.x[PENDULUM.iqm.argmax()], *PENDULUM.at(PENDULUM.x[PENDULUM.iqm.argmax()])],
    ),
    Text(
        "on the half-cheetah (# at 40,000) and at the pendulum's end (# at 6,000)",
        [thesis("half-cheetah", HYBRID).at(40_000)[0], thesis("pendulum", HYBRID).at(6_000)[0]],
    ),
    agreement(
        " | first row | highest | last | highest over last", SIGNAL, after="The agreement signal"
    ),
    agreement(
        " | first row | highest | last | last over first",
        "planner/insertion_per_variance",
        after="Per unit of the policy's variance",
    ),
    Text(
        "last, rises as well: # to # on the half-cheetah, # to # on the hopper, # to # on the "
        "cartpole, # to # on the pendulum",
        [end for task in TASKS for end in ratio_of_means(task)],
    ),
    Text(
        "seeds lie on both sides (# to #)",
        [PENDULUM_SIGNAL.seeds(6_000).min(), PENDULUM_SIGNAL.seeds(6_000).max()],
    ),
    Text(
        "it goes from # to # after 4,200",
        [PENDULUM_SIGNAL.at(4_200)[0], PENDULUM_SIGNAL.at(6_000)[0]],
    ),
    returns(f"{BAND} | hybrid_stochastic | sac | nn_mppi", DEFAULTS),
    areas(AREAS, DEFAULTS, HYBRID, after="to where the shortest curve ends"),
    Text(
        "(pendulum: # and #)",
        [default("pendulum").at(10_000)[0], default("pendulum", "sac").at(10_000)[0]],
    ),
    Text("Gymnasium's older versions): # at 100,000", [CHEETAH.at(100_000)[0]]),
    Text("At 50,000: #, MBPO 7,963", [CHEETAH.at(50_000)[0]]),
    Text("The IQM passes 5,000 between # and # decisions", passes(CHEETAH, 5_000)),
    Text(
        "# of 10 seeds have passed it by 15,000, # by 50,000",
        [passed(CHEETAH, 5_000, 15_000), passed(CHEETAH, 5_000, 50_000)],
    ),
    Text(
        "seed 2 has #, the others # to #: one",
        [CHEETAH.seeds(100_000)[2], END[0], END[-1]],
    ),
    Text(
        "Hopper: # at 100,000 (at 50,000: #, [over 30 seeds #]",
        [HOPPER.at(100_000)[0], HOPPER.at(50_000)[0], hopper.ALL["default"][0]],
    ),
    Text("# of 10 seeds pass 3,000 at some evaluation", [passed(HOPPER, 3_000, 100_000)]),
    Text("the IQM passes 800 between # and # decisions", passes(DM, 800)),
    Text(
        "our SAC #). Stopped",
        passes(default("cartpole, dm_control's reward", "sac"), 800)[1:],
    ),
    side_by_side(
        f"{BAND} | policy alone, K 20, lambda 1 | policy and noise, K 32, lambda 0.3",
        {
            "policy alone, K 20, lambda 1": "variant_policy_candidates",
            "policy and noise, K 32, lambda 0.3": "variant_one_batch",
        },
    ),
    side_by_side(
        f"{BAND} | now | one batch for all models",
        {"now": None, "one batch for all models": "variant_one_batch"},
    ),
    Text(
        "(Mann-Whitney p # at 50,000, # at 75,000)",
        [p_value(HOPPER.seeds(x), hopper.EARLIER.seeds(x)) for x in (50_000, 75_000)],
    ),
    *hopper.CITED,
    side_by_side(
        f"{BAND} | nothing imagined | imagined data, five models, ten updates",
        {
            "nothing imagined": "variant_nothing_imagined",
            "imagined data, five models, ten updates": "variant_policy_candidates",
        },
    ),
    Text(
        "with 5,000 random decisions had # [#, #] at 40,000 on the half-cheetah, "
        "with 10,000 it has # [#, #]",
        [
            *curve("variant_nothing_imagined", "sac, 5,000 random decisions").at(40_000),
            *default("half-cheetah", "sac").at(40_000),
        ],
    ),
]
PLAIN = [
    # settings, and where the text points at a decision
    "Seeds 0 to 9",
    "Seeds 0 to 9, a server's CPU",
    "needs 4,000",
    "stopped at 48,000 of 80,000 decisions",
    "Agarwal et al. 2021",
    "Cartpole, 8,000 decisions",
    "Half-cheetah, 40,000:",
    "Hopper, 48,000:",
    "of pairs of seeds at 24,000",
    "though the bands overlap at 40,000",
    "at 40,000",
    "at 6,000",
    "after 4,200",
    "stopped at 24,000 of 80,000 decisions",
    "three layers of 200",
    "with 32 candidates",
    "(K 64, T 20)",
    "after 10,000 random decisions",
    "seeds 0 to 2",
    "at 100,000, MBPO",
    "At 50,000:",
    "passes 5,000",
    "of 10 seeds have passed it by 15,000",
    "by 50,000. At the end seed 2 has",
    "one seed in ten",
    "Hopper: # at 100,000 (at 50,000:",
    "reaches 3,000",
    "of 10 seeds pass 3,000 at some evaluation; the others stay near 1,000",
    *hopper.PLAIN,
    "the hybrid after 2,000",
    "Both make 1,000 random decisions",
    "passes 800",
    "Stopped at 20,000",
    "ahead of it until 4,000",
    "(K 20, lambda 1, T 3)",
    "10,000 random decisions on half-cheetah",
    "seeds 0 to 9",
    "with 5,000 random decisions",
    "with 10,000 it has",
    "`nn_mppi` beyond 50,000",
    # what others published
    "MBPO 9,573, DHMBPO 9,878, the strongest SAC 7,039",
    "MBPO 7,963, DHMBPO 7,356, SAC 5,733",
    "(DHMBPO 20,000, MBPO 26,000)",
    "(MBPO 68,000, MACURA 35,000, DHMBPO 30,000 decisions)",
    "MBPO 1,702, DHMBPO 3,470), and",
    "(DHMBPO 30,000, SAC and TD-MPC2 100,000 steps",
    # read from the console; the page says so
    "to 100,000 decisions, took about 19 minutes",
]
