"""The sections of docs/results/robots.md on planning on the world, and on other worlds."""

import json
from typing import Any

import numpy as np

from pages.cited import Table, Text
from pages.sawyer import share
from pages.values import read

WORLD = {
    "Sawyer, env.reward=code": "sawyer_code",
    "Sawyer, env.reward=code, white noise": "sawyer_white",
    "Sawyer, the printed reward": "sawyer_thesis",
    "Panda, env.reward=joined": "panda_joined",
}


def planned(label: str, column: str) -> list[float]:
    """A cell of the table of planning on the world itself."""
    one = read("world_planning")["tasks"][WORLD[label]]
    success, decisions = np.array(one["success"]), np.array(one["decisions"])
    values = {
        "episodes": len(success),
        "successes": 100 * success.mean(),
        "decisions until success, median": np.median(decisions[success == 1]),
        "return, mean": np.mean(one["return"]),
        "processor time per decision, s": np.sum(one["cpu_s"]) / decisions.sum(),
    }
    return [float(values[column])]


WHITE = read("world_planning")["tasks"]["sawyer_white"]["success"]


def first(name: str) -> float:
    """Successes in the episodes that were run with white noise."""
    return sum(read("world_planning")["tasks"][name]["success"][: len(WHITE)])


def real_time(name: str) -> float:
    """Simulated time per processor time; a decision is 0.1 s."""
    one = read("world_planning")["tasks"][name]
    return 0.1 * sum(one["decisions"]) / sum(one["cpu_s"])


SECONDS = {"quadcopter": 0.025, "half-cheetah": 0.05, "ant": 0.05}  # [s] of a decision


def returned(label: str, column: str) -> list[float]:
    """A cell of the table of returns."""
    one = read("world_planning")["tasks"][label.replace("-", "")]
    seconds = np.sum(one["cpu_s"]) / np.sum(one["decisions"])
    values = {
        "episodes": [len(one["return"])],
        "return": [np.mean(one["return"]), min(one["return"]), max(one["return"])],
        "processor time per decision, s": [seconds],
        "share of real time": [SECONDS[label] / seconds],
    }
    return [float(each) for each in values[column]]


KEYS = {
    "as in training": {},
    "block of half the mass": {"env.block_mass": "0.05"},
    "of twice the mass": {"env.block_mass": "0.2"},
    "noise of 2 mm on positions": "episode.sensor_noise",
    "actions a decision later": {"episode.delay": "1"},
}
FRICTION = {"half the friction": {"sawyer": "0.2", "panda": "0.5"}}
FRICTION["twice the friction"] = {"sawyer": "0.8", "panda": "2.0"}


def disturbed(label: str, column: str) -> list[float]:
    """[%] of successes in another world: mean, lowest and highest seed."""
    robot = column.split(",")[0].lower()
    key: Any = KEYS.get(label) if label in KEYS else {"env.block_friction": FRICTION[label][robot]}
    rows = read("robustness")["robots"][robot]["rows"]
    found = [r for r in rows if (list(r["changes"]) == [key] or r["changes"] == key)]
    assert len(found) == 1, json.dumps(found)
    each = 100 * np.array(found[0]["success"])
    return [each.mean(), each.min(), each.max()]


POOR = read("world_planning")["panda_poor"]
ARMS = {
    "the clone alone": "clone",
    "candidates of the clone": "candidates",
    "half of the candidates from the clone, half noise through knots": "mixture",
}


def repaired(label: str, column: str) -> list[float]:
    """A cell of the table of plans with candidates of a poor clone."""
    if label in ARMS:
        one = POOR["arms"][ARMS[label]]
    else:
        one = read("world_planning")["tasks"]["panda_joined"]
        assert one["seed"][: len(POOR["seeds"])] == POOR["seeds"]
    count = len(POOR["seeds"])
    values = one["success" if "successes" in column else "return"][:count]
    return [float(sum(values) if "successes" in column else np.mean(values))]


WRONG = {
    "half the mass": "env.block_mass=0.05",
    "twice the mass": "env.block_mass=0.2",
    "half the friction": "env.block_friction=0.2",
    "twice the friction": "env.block_friction=0.8",
}


def mistaken(label: str, column: str) -> list[float]:
    """A cell of the table of mppi whose physics have another block than the world."""
    if label in WRONG:
        one = read("world_planning")["sawyer_wrong_world"][WRONG[label]]
    else:
        one = read("world_planning")["tasks"]["sawyer_code"]
    assert one["seed"][:10] == list(range(10))
    success, decisions = np.array(one["success"][:10]), np.array(one["decisions"][:10])
    return [float(success.sum() if "of 10" in column else np.median(decisions[success == 1]))]


def on_gpu(label: str, column: str) -> list[float]:
    """A cell of the table of planning on a GPU."""
    one = read("world_planning")["gpu"]["tasks"][label.split(",")[0].lower()]
    seconds = one["evaluation_wall_s"] / one["decisions"]
    return [seconds if "seconds" in column else one["decision_s"] / seconds]


AS_TRAINED = disturbed("as in training", "Sawyer")[0]
MILD = set(KEYS) | {"twice the friction"}
CITED = [
    Table(
        "the block in the world alone | successes of mppi, of 10 | decisions until success, median",
        mistaken,
    ),
    Table("a poor clone, on the true world | successes, of 7 | return, mean", repaired),
    Text(
        "it stacks in #% of # episodes",
        [100 * POOR["clone_evaluated"]["success"], POOR["clone_evaluated"]["episodes"]],
    ),
    Table(
        "planned on the world | episodes | successes | decisions until success, median"
        " | return, mean | processor time per decision, s",
        planned,
    ),
    Text(
        "succeeds in # of the Sawyer's first # episodes, with noise through knots in #",
        [first("sawyer_white"), len(WHITE), first("sawyer_code")],
    ),
    Text(
        "the Sawyer at # and the Panda at # of real time",
        [real_time("sawyer_code"), real_time("panda_joined")],
    ),
    Table("mppi on an H200 | seconds per decision | share of real time", on_gpu),
    Text("on other processors, has #% after", [share("hybrid_stochastic", "60")[0]]),
    Text("costs the Sawyer # points", [AS_TRAINED - disturbed("half the friction", "Sawyer")[0]]),
    Text(
        "more than # points",
        [np.ceil(max(AS_TRAINED - disturbed(one, "Sawyer")[0] for one in MILD))],
    ),
    Table(
        "returns of mppi | episodes | return | processor time per decision, s | share of real time",
        returned,
    ),
    Table("successes in another world | Sawyer, hybrid_stochastic | Panda, cloned", disturbed),
]
PLAIN = [
    "Seeds 0 to 9, one episode each",
    "(0.1 kg, friction 0.4)",
    "with five demonstrations, seed 0, learned on",
    "One episode for each seed from 0 to 6",
    "64 candidates of 20 decisions (2 s), whose noise of 0.7",
    "tried on seeds 200 and up",
    "each seed from 0 on, up to 10 s for the Sawyer and 20 s for the Panda",
    "A decision lasts 0.1 s",
    "Sawyer after 6,000 decisions",
    "from 5 demonstrations; 100 episodes a seed",
    "wait for one another, 400 of them for an arm, and 64 candidates",
    "30 decisions of an evaluation",
    "after 6,000 decisions.\n",
    "10,000 random decisions in each of 256 worlds, MuJoCo Warp",
    "(0.1 and 0.4 in the Sawyer's, 0.1 and 1 in the Panda's world)",
    "on seed 200",
    "training and the controller does not: mean over seeds 0 to 9",
]
