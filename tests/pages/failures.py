"""The pictures of failures on docs/results/robots.md: Sawyer and Panda."""

import numpy as np

from pages.cited import Text
from pages.values import read

FILE = read("failures")
SAWYER, PANDA = FILE["sawyer_push"], FILE["panda_stack"]
WAY = np.array(SAWYER["shown"]["distance_m"])  # after each decision
STOPPED = int(np.argmax(np.abs(WAY - WAY[-1]) < 1e-4))


def left(seed: int) -> np.ndarray:
    """[mm] from the block to its target at the end of the failed episodes of a seed."""
    each = PANDA["failed"]
    return np.array(
        [1000 * d for d, s in zip(each["distance_m"], each["seed"], strict=True) if s == seed]
    )


def held(seed: int) -> int:
    """Failed episodes of a seed at whose end the hand holds the block."""
    each = PANDA["failed"]
    return sum(g for g, s in zip(each["grasped"], each["seed"], strict=True) if s == seed)


CITED = [
    Text(
        "the one failure in # episodes of seed 0, which was trained again on the EPYC",
        [SAWYER["episodes"]],
    ),
    Text(
        "stops # mm from its target after # decisions, where less than 50 mm are a success",
        [1000 * WAY[-1], STOPPED],
    ),
    Text(
        "trained again on the EPYC, seed 0 succeeds in #%, seed 1 in #%, the others in all",
        PANDA["succeeded"][:2],
    ),
    Text(
        "In # of the # episodes in which seed 0 fails, the hand holds the block # to # mm from its "
        "target",
        [held(0), len(left(0)), left(0).min(), left(0).max()],
    ),
    Text(
        "In # of the # in which seed 1 fails it holds it, too; the block is # to # mm away",
        [held(1), len(left(1)), left(1).min(), left(1).max()],
    ),
]
PLAIN = [
    "episodes of seed 0, which was trained again",
    "less than 50 mm are a success",
    "The pictures: after 0, 20, 30 and 100 decisions",
    "seed 0 succeeds in #%, seed 1 in #%, the others in all of their 100 episodes",
    "in which seed 0 fails",
    "in which seed 1 fails",
    "opens at 10 mm. The pictures: after 0, 35, 60 and 200 decisions",
]
