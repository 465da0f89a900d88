"""The section of docs/results/chapter3.md on deterministic hybrid learning."""

from pages.cited import Table, Text
from pages.values import Curve, ahead, curve, number, spread

TASKS = ("half-cheetah", "hopper", "cartpole", "pendulum")
THESIS = {task: f"fig_3_2_{task.replace('-', '')}" for task in TASKS}
ADJOINT = {task: f"fig_3_1_{task.replace('-', '')}" for task in TASKS}
HYBRID, DETERMINISTIC = "hybrid_stochastic", "hybrid_deterministic"
SIGNAL = "planner/mode_insertion_gradient"
BAND = "evaluation return, IQM and 95% band"


def thesis(task: str, label: str) -> Curve:
    """A line of figure 3-2."""
    return curve(THESIS[task], label)


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


PENDULUM = adjoint("pendulum", DETERMINISTIC)
PENDULUM_SIGNAL = curve(ADJOINT["pendulum"], DETERMINISTIC, SIGNAL)
DETERMINISTIC_AREAS = (
    " | hybrid_deterministic | deterministic_mpc | one_step_mpc | sac | ahead of deterministic_mpc"
    " | ahead of one_step_mpc | ahead of sac"
)
CITED = [
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
]
