"""docs/results/robots.md."""

import json
from typing import Any

import numpy as np

from pages import ant, ant_best, failures, planned, sawyer
from pages.ant import expert
from pages.cited import ROOT, Table, Text
from pages.values import ahead, curve, number, read

PAGE = "docs/results/robots.md"


def stacked(label: str, column: str) -> list[float]:
    """[%] of successes: mean, lowest and highest seed."""
    each = 100 * curve("fig_3_6", label).seeds(number(column))
    return [each.mean(), each.min(), each.max()]


def apart(label: str, column: str) -> list[float]:
    """[millionths] by which a decision differs from Gymnasium's."""
    name, physics = label.rsplit(", ", 1)
    key = {"median": "state_median", "99%": "state_99", "largest": "state_max"}[column]
    return [1e6 * compared(name, physics)[key]]


def compared(name: str, physics: str) -> dict[str, Any]:
    """The row of gymnasium.json."""
    rows = json.loads((ROOT / "docs/results/gymnasium.json").read_text(encoding="utf-8"))["rows"]
    return next(row for row in rows if (row["name"], row["physics"]) == (name, physics))


FEW = read("panda_few")
CLONED = {  # label on the page -> row
    "env.observation=stage": "plain",
    "experiment=robots/panda: the same, a disturbed expert": "panda",
    "experiment=robots/panda algo=hybrid_bc": "hybrid",
}


def few(label: str, column: str) -> list[float]:
    """A cell of the table of clones from few demonstrations: a share [%], or episodes."""
    count = column.split()[0]
    if label not in CLONED:
        return [10] if "episodes" in column else stacked("bc", count)
    row = FEW["rows"][CLONED[label]]
    if "episodes" in column:
        return [row["episodes"]]
    if CLONED[label] == "panda" and count not in row["success"]:
        row = FEW["rows"]["panda_server"]
    return share(row["success"][count])


def share(success: list[float]) -> list[float]:
    """[%] mean, lowest and highest of the seeds' shares, of which there are ten."""
    each = 100 * np.array(success)
    assert len(each) == len(FEW["seeds"])
    return [each.mean(), each.min(), each.max()]


def tried(**settings: Any) -> dict[str, Any]:
    """The one trial with these settings, by default those of the first trials."""
    wanted = {"demonstrations": 5, "disturbed": False, "hidden": [32, 24], "steps": 2000} | settings
    (one,) = (trial for trial in FEW["tried"] if all(trial[key] == wanted[key] for key in wanted))
    return one


def episodes(trial: dict[str, Any]) -> list[float]:
    """Successes, and episodes, of a trial."""
    return [trial["succeeded"], trial["episodes"]]


NARROW = tried(observation="thesis")
THREE = {"observation": "thesis", "hidden": [256, 256], "steps": 5000, "demonstrations": 3}
SMALL = {"observation": "stage", "hidden": [64, 64], "steps": 5000, "demonstrations": 2}
TWO = {disturbed: tried(**SMALL, disturbed=disturbed) for disturbed in (False, True)}
ONE = FEW["rows"]["panda_server"]["success"]["1"]
ALONE = tried(**SMALL | {"demonstrations": 1}, disturbed=True)
WIDE, WIDER = tried(observation="thesis", hidden=[256, 256]), tried(**THREE)


POINTS, CAPSULES = compared("ant, points", "native"), compared("ant, capsules", "mjx")
CITED = [
    *planned.CITED,
    *sawyer.CITED,
    *ant.CITED,
    *ant_best.CITED,
    *failures.CITED,
    Table(
        "after 20 episodes | evaluation return, IQM and 95% band",
        lambda label, _: curve("fig_3_3", label).at(2_000),
    ),
    Table("demonstrations | 1 | 2 | 3 | 5 | 10", stacked),
    Text("have # on average", [expert().mean()]),
    Text("is ahead of its expert (#)", [expert().mean()]),
    Table(
        "cloned from | episodes per seed | 1 demonstration | 2 demonstrations | 3 demonstrations"
        " | 5 demonstrations | 10 demonstrations",
        few,
    ),
    Text(
        "from it # of # clones succeed in all of their episodes, one in #% and one in #%",
        [sum(each == 1 for each in ONE), len(ONE), *sorted(100 * each for each in ONE)[1::-1]],
    ),
    Text("with other demonstrations, # of # episodes succeeded", episodes(ALONE)),
    Text(
        "# episodes of four clones of the thesis' network (five demonstrations, our rate) # "
        "failed: # times the hand pushed the block away before it came within the centimetre at "
        "which it closes, # times it released it elsewhere",
        [
            NARROW["episodes"],
            NARROW["episodes"] - NARROW["succeeded"],
            NARROW["failed"]["pushed the block away"],
            NARROW["failed"]["released it elsewhere"],
        ],
    ),
    Text(
        "with it # of # episodes succeeded, without it # (relative",
        [
            tried(observation="relative, velocity")["succeeded"],
            NARROW["episodes"],
            tried(observation="relative")["succeeded"],
        ],
    ),
    Text(
        "256 reach # of # at five demonstrations, and # of # at three, where a disturbed expert "
        "gives #",
        [
            WIDE["succeeded"],
            WIDE["episodes"],
            WIDER["succeeded"],
            WIDER["episodes"],
            tried(**THREE, disturbed=True)["succeeded"],
        ],
    ),
    Text(
        "three demonstrations, # of # episodes succeeded, with the vectors to block and target in "
        "all stages (`env.observation=relative`) # of #, and with the thesis' observation # of #",
        [
            value
            for seen in ("stage", "relative", "thesis")
            for value in episodes(tried(**SMALL | {"observation": seen, "demonstrations": 3}))
        ],
    ),
    Text(
        "at two it raised # successes in # episodes to #",
        [TWO[False]["succeeded"], TWO[False]["episodes"], TWO[True]["succeeded"]],
    ),
    Table(
        "queries to the expert by hand | episodes that succeed",
        lambda label, _: share(FEW["rows"]["dagger"]["success"][label]),
    ),
    Table(
        "demonstrations | 1 | 2 | 3 | 4 | 6 | 8 | 10",
        lambda label, column: curve("fig_3_5", label).at(number(column)),
    ),
    Text(
        "cloning ahead in #% [#, #] of pairs",
        ahead(curve("fig_3_5", "bc").area(), curve("fig_3_5", "hybrid_bc").area()),
    ),
    Text("Its ten episodes, # to #, are", [expert().min(), expert().max()]),
    Table("millionths | | median | 99% | largest", apart),
    Text("rates part by up to # rad/s in a decision", [POINTS["state_max"]]),
    Text("(median over all decisions #)", [POINTS["state_median"]]),
    Text("up to # rad/s with MJX, median #", [CAPSULES["state_max"], CAPSULES["state_median"]]),
    Text(
        "Ant-v5 is # a decision on average, at most #",
        [CAPSULES["contact_cost_mean"], CAPSULES["contact_cost_max"]],
    ),
]
PLAIN = [
    *planned.PLAIN,
    *sawyer.PLAIN,
    *ant.PLAIN,
    *ant_best.PLAIN,
    *failures.PLAIN,
    # settings
    "columns 1, 2 and 10 (`num_demonstrations=1,2,10`)",
    "seeds 0 to 9, 10 evaluation episodes per seed",
    "jax 0.11.2",
    "episodes of 10 s",
    "within 20 episodes",
    "of 100 episodes: mean over seeds",
    "from 5 demonstrations on",
    "learn at 0.003: with the thesis' rate of 0.01",
    "for 1 cm",
    "over 400 decisions",
    "IQM and 95% band; parameters of the thesis",
    "the thesis' 20 decisions",
    "a rate of 0.003",
    "the thesis' rate of 0.01",
    "over 64 worlds, eight updates for 64 decisions, 2.4 M decisions",
    "the 27 entries of the observation",
    "20 episodes of up to 100 decisions, each decision",
    "less than 30 degrees",
    "was 0.003 (data not saved)",
    "Of the return of 2,015 that",
    "over 20 episodes of up to 1,000 decisions, it would take 0.7",
    "and 1,604 on the points that it was trained on (standard deviations 672 and 918;",
    "about 87,000 physics steps a second of the walker and 64,000 of the ant",
    "capsules (64 worlds",
    "10,000 random decisions in each of 256 worlds",
    "up to 99 of planning on the world itself",
    "mean of the weights over about the last 500",
    "5,000 gradient steps",
    "hold about 270 labels",
    "Not varied by themselves: two layers of 64",
    "With the thesis' observation two layers of 256",
    "20 episodes per seed): the expert drives for 80 decisions",
    "The Sawyer's 20 episodes",
]
