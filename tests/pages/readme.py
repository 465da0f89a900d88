"""The numbers of README.md."""

from pages import (
    ant_best,
    chapter3,
    chapter6_values,
    chapter7_falls,
    fast,
    lookahead,
    results,
    robots,
    sawyer,
    walker,
)
from pages.cited import Table, Text
from pages.values import number

PAGE = "README.md"


def main_table(label: str, column: str) -> list[float]:
    """A cell of a row such as "thesis settings, half-cheetah, 40,000 decisions"."""
    settings, task = label.split(", ", 1)
    task = task[: task.rindex(", ")]
    line = {"thesis settings": chapter3.thesis, "defaults": lookahead.hybrid}.get(settings)
    return (line or chapter3.default)(task, column).at(number(label.split(" (")[0]))[:1]


def sac(label: str, x: float) -> list[float]:
    """IQM and band of a curve of the comparison with Stable-Baselines3."""
    return results.curve(results.FILE, label, task="halfcheetah").at(x)


FALLS = chapter7_falls.methods("2")["koopman_active"]
AT_REST = FALLS["at_rest"]["4"][0] * FALLS["trials"]
SEARCH = chapter6_values.search(chapter6_values.SEARCHES["kle3_bayesopt"], "trials that reach it")
CITED = [
    Text("from six demonstrations (#% of its", [ant_best.share(ant_best.best(6))]),
    Text("to a return of # (interquartile mean of ten", results.TEN.at(30_000)[:1]),
    Table(" | hybrid_stochastic | nn_mppi | sac", main_table),
    Text(
        "our SAC matches Stable-Baselines3's: # [#, #] and # [#, #] at 100,000",
        [*sac("sac", 100_000), *sac(results.OURS, 100_000)],
    ),
    Text(
        "with a mean of # to DHMBPO's 9,149, at 400,000 (four seeds) with # to",
        [
            float(lookahead.hybrid("half-cheetah").seeds(50_000).mean()),
            *lookahead.longer("400,000", "mean return"),
        ],
    ),
    Text(
        "the mean is #, with `settings=fast` #, to 11,177",
        [
            float(line.seeds(100_000).mean())
            for line in (lookahead.hybrid("half-cheetah"), fast.line("half-cheetah"))
        ],
    ),
    Text("and a return of # ([interquartile", fast.line("half-cheetah").at(100_000)[:1]),
    Text(
        "ahead with # to 3,364 at 50,000 and the walker a little behind with # to 7,445 at "
        "100,000; the ant is behind with # to 5,225 at 50,000",
        [
            walker.mean("hopper", 50_000),
            walker.mean("walker2d", 100_000),
            float(lookahead.hybrid("ant").seeds(50_000).mean()),
        ],
    ),
    Text("KL-E3 finds the highest peak in # of # trials", SEARCH),
    Text(
        "it needs # measurements where LQR-Bayesian optimisation needs #;",
        [chapter6_values.KLE3, chapter6_values.LQR],
    ),
    Text(
        "stops in # of # falls, after # s",
        [AT_REST, FALLS["trials"], FALLS["median_time_at_rest"]],
    ),
    Text(
        "it succeeds in #% of the evaluation episodes, SAC in #%",
        [sawyer.share(label, "60")[0] for label in ("hybrid_stochastic", "sac")],
    ),
    Text(
        "stacks one block on another in #% of the episodes",
        robots.few("experiment=robots/panda: the same, a disturbed expert", "3 demonstrations")[:1],
    ),
    Text("(position weight 500) # against #", chapter6_values.QUICK[::-1]),
]
PLAIN = [
    "None of [64 seeds]",
    "half-cheetahs reach 100,000 decisions in eight minutes",
    "at 400,000 (four seeds)",
    "to 13,184",
    "at 100,000 the mean",
    "to 11,177. None",
    "gait of about 2,000. Where",
    "to 3,364 at 50,000",
    "to 7,445 at 100,000",
    "to 5,225 at 50,000",
    # settings and versions
    "(Northwestern University, 2020)",
    "Python 3.11 to 3.13",
    "30,000 decisions in about six minutes on two cores",
    "CUDA 13",
    "seeds 0 to 9",
    "chosen on seeds 200 to 204 and ran on 100 to 109 (cartpole and pendulum: 104)",
    "at 50,000 decisions",
    "DHMBPO's 9,149",
    "at 100,000",
    "(position weight 5)",
    "(position weight 500)",
    "SE(3)",
    "Gymnasium v5",
    "after 6,000 decisions, ten minutes of the robot's time",
    "Apache-2.0",
]
