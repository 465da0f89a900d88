"""docs/results/chapter3.md."""

from collections.abc import Sequence

import numpy as np

from pages import figure_3_1, hopper
from pages.cited import Table, Text
from pages.figure_3_1 import BAND, HYBRID, TASKS, THESIS, thesis
from pages.values import Curve, areas, curve, number, p_value, returns

PAGE = "docs/results/chapter3.md"
DEFAULTS = {task: f"defaults_{task.replace('-', '')}" for task in TASKS} | {
    "cartpole, dm_control's reward": "defaults_cartpole_dm"
}


def default(task: str, label: str = HYBRID) -> Curve:
    """A line of a picture of defaults."""
    return curve(DEFAULTS[task], label)


def alone(task: str, half: str, label: str = HYBRID) -> Curve:
    """A line of figure 3-4; half: policy or planner."""
    return curve(f"fig_3_4_{task.replace('-', '')}_{half}", label)


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
END = np.sort(np.delete(CHEETAH.seeds(100_000), 2))
AREAS = " | hybrid_stochastic | nn_mppi | sac | ahead of nn_mppi | ahead of sac"
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
    *figure_3_1.CITED,
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
        f"{BAND} | settings=mbpo | one batch for all models",
        {"settings=mbpo": None, "one batch for all models": "variant_one_batch"},
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
    "MBPO 9,573, DHMBPO 11,177, the strongest SAC 7,039",
    "MBPO 7,963, DHMBPO 9,149, SAC 5,733",
    "(MBPO 26,000)",
    "is ahead of them at 50,000",
    "(MBPO 68,000, MACURA 35,000, DHMBPO 30,000 decisions)",
    "MBPO 1,702, DHMBPO 3,500), and",
    "(DHMBPO 30,000, SAC and TD-MPC2 100,000 steps",
    # read from the console; the page says so
    "to 100,000 decisions, took about 19 minutes",
]
