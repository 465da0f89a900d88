"""The sections of docs/results/robots.md on Sawyer from rewards alone."""

import numpy as np

from pages.cited import Table, Text
from pages.values import ahead, p_value, read

HOME, MODEL = read("sawyer_home"), read("sawyer_model")
COLUMNS = {"after 20 episodes": 2_000, "40": 4_000, "60": 6_000}
ERRORS = {"contact": "contact", "free": "free", "10 decisions": "ahead_10"}
ERRORS["20 decisions"] = "ahead_20"


def share(label: str, column: str) -> list[float]:
    """[%] of successes: mean, lowest and highest seed."""
    method = HOME["methods"][label]
    each = method["success"][HOME["decisions"].index(COLUMNS[column])]
    return [100 * np.mean(each), 100 * min(each), 100 * max(each)]


def counted(method: str) -> list[float]:
    """Successes, and episodes, at all evaluations together."""
    shares, episodes = (
        np.array(HOME["methods"][method]["success"]),
        HOME["methods"][method]["episodes"],
    )
    return [round(episodes * shares.sum()), episodes * shares.size]


def earlier(method: str) -> list[float]:
    """[%] of successes at the three evaluations of the earlier runs."""
    return [100 * np.mean(each) for each in HOME["earlier"][method]["success"]]


def areas(method: str) -> np.ndarray:
    """[S] mean share of successes up to the last evaluation; the first holds from 0 on."""
    success, x = np.array(HOME["methods"][method]["success"]), HOME["decisions"]
    return np.trapezoid(np.concatenate([success[:1], success]), [0, *x], axis=0) / x[-1]


HYBRID, PLANNER = "hybrid_stochastic", "nn_mppi"


def error(label: str, column: str) -> list[float]:
    """[mm] of the block's position, mean over seeds."""
    return [float(np.mean([row[ERRORS[column]] for row in MODEL["mm"][label]]))]


def moved(name: str) -> float:
    """[mm] that the block moved, mean over seeds."""
    return float(np.mean([row[name] for row in MODEL["mm"]["command"]]))


def searched(name: str) -> float:
    """[%] of successes on the seeds of the search."""
    return 100 * float(np.mean(HOME["search"]["success"][name]))


CITED = [
    Text(
        "ahead in #% [#, #] of pairs of seeds, by area. Its", ahead(areas(HYBRID), areas(PLANNER))
    ),
    Text(
        "the medians of the seeds are #% and #%",
        [100 * np.median(HOME["methods"][name]["success"][0]) for name in (HYBRID, PLANNER)],
    ),
    Text(
        "the hybrid had #%, #% and #%, `nn_mppi` #%, #% and #%", earlier(HYBRID) + earlier(PLANNER)
    ),
    Text(
        "the hybrid was one point ahead and is now # behind",
        [share(PLANNER, "after 20 episodes")[0] - share(HYBRID, "after 20 episodes")[0]],
    ),
    Text(
        "which chance explains (p = #, Mann-Whitney)",
        [p_value(*(np.array(HOME["methods"][name]["success"][0]) for name in (HYBRID, PLANNER)))],
    ),
    Text("`sac` succeeds in # of its # episodes", counted("sac")),
    Table("share of successes | after 20 episodes | 40 | 60", share),
    Table(
        "error of the block's position, mm | contact | free | 10 decisions | 20 decisions", error
    ),
    Text(
        "succeeds in #% of # evaluation episodes after # decisions, without it in #%",
        [searched("frame"), 60, HOME["search"]["decisions"], searched("no frame")],
    ),
    Text("by # and # mm on average", [moved("moved_10"), moved("moved_20")]),
    Text("learn from # recorded decisions", [MODEL["decisions"]]),
]
PLAIN = [
    "64 candidates of 20 decisions have noise",
    "has 16 more of its policy",
    "of ten seeds (0 to 9), 100 evaluation episodes a seed (`eval_episodes=100`)",
    "includes 50%. After 20 episodes the medians",
    "on the EPYC, 10 episodes a seed)",
    "After 60 episodes nothing has changed. After 20 the hybrid",
    "counted as 100 decisions",
    "chosen on seeds 200 to 202",
    "(seeds 200 to 202, 20 episodes a seed",
    "a temperature of 0.3 the planner",
    "16 of 80 and a temperature of 0.1",
    "that (seeds 200 to 202, data not saved)",
    "after 3,000 decisions, four of 120 on seeds 200 to 202",
    "two layers of 128 learn",
    "more than 0.5 mm",
    "Over 10 and 20 recorded decisions: paths on which the block moves by more than 1 cm",
    "Over 20 decisions the hidden command",
    "Over 20 decisions it is about level",
]
