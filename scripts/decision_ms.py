"""Milliseconds from an observation to an action, of policies and planners, on one core or a GPU.

    taskset -c 0 python -m scripts.decision_ms out=docs/results/decision_ms.json
    taskset -c 1 python -m scripts.decision_ms of=goals out=docs/results/planner_ms.json

As the robot's process decides (outside.acting.Exploring), after a warm-up, with XLA in one thread;
where there is a GPU, it computes. Parameters are the first ones: the time does not depend on them.
For machines that do other work: `best` is the fastest decision, `processor` the time of the core in
the fastest block. of=goals: who acts in scripts.new_goals, `planner=refits`, and the live window's
quick planner, on a reward that no run was trained on.
"""

import json
import os
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

os.environ["XLA_FLAGS"] = os.environ.get("XLA_FLAGS", "") + " --xla_cpu_multi_thread_eigen=false"

import jax
import numpy as np

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import Argument, one_of, read
from hybrid_rl.errors import UsageError
from hybrid_rl.outside.acting import Exploring
from hybrid_rl.run.machine.provenance import device
from hybrid_rl.run.retarget import retargeted
from hybrid_rl.run.saved import Trained
from hybrid_rl.settings import build as configuration
from hybrid_rl.tools.view.subject import quicker
from hybrid_rl.training.agent import Agent
from hybrid_rl.types import Params
from scripts.new_goals import overrides, rows
from scripts.seeds import split_names

ARGUMENTS = (
    Argument("of", "methods", "or goals: planners for a new reward", one_of("methods", "goals")),
    Argument("only", "", "of these tasks, with ; between them; empty: all"),
    Argument("who", "", "of=goals: these planners, with ; between them; empty: all"),
    Argument("out", "decision_ms.json", "the numbers"),
)
CALLS, BLOCK = {"methods": 500, "goals": 100}, 10
METHODS = {
    "policy (settings=light)": ["algo=sac", "settings=light"],
    "policy": ["algo=sac"],
    "policy and planner (settings=light)": ["algo=hybrid_stochastic", "settings=light"],
    "policy and planner": ["algo=hybrid_stochastic"],
    "planner alone": ["algo=nn_mppi"],
    "deterministic hybrid": ["algo=hybrid_deterministic"],
}
TASKS = ("cartpole", "halfcheetah", "ant")
GOALS = {
    "halfcheetah": (["task=halfcheetah"], "speed 2"),
    "quadcopter": (["task=quadcopter", "episode.action_repeat=4"], "aim motion [0,0,0,0,0,1]"),
    "sawyer_push": (["task=sawyer_push"], "push [0.1,0]"),
    "halfcheetah, settings=light": (["task=halfcheetah", "settings=light"], "speed 2"),
}
WHO = (
    *("policy", "planner: noise", "both: mixture", "both: strengths", "refits"),
    *("planner: gradient", "both: gradient", "both: gradient, quick"),
)


def methods(only: list[str]) -> Iterator[tuple[str, str, Agent]]:
    """(task, name, agent) of each method as it trains."""
    for task in only or TASKS:
        for name, words in METHODS.items():
            config = configuration.load([f"task={task}", *words])
            yield task, name, configuration.build(config).agent


def goals(only: list[str], who: list[str]) -> Iterator[tuple[str, str, Agent]]:
    """(robot, who acts, agent) of each planner for a new reward."""
    for robot in only or GOALS:
        words, goal = GOALS[robot]
        run = configuration.build(configuration.load([*words, "algo=hybrid_stochastic"]))
        agent, now = run.agent, run.controllers
        trained = Trained(robot, agent.episode, now, Params(), (0,), 0, (), run.config)
        known = rows(retargeted(trained, overrides(goal)))
        refits = retargeted(trained, [*overrides(goal), "planner=refits"])
        known["refits"] = refits.controllers["full"]
        known["both: gradient, quick"] = quicker(known["both: gradient"])
        for name in who or WHO:
            if name not in known:
                raise UsageError(f"who={name}: choose from {'; '.join(WHO)}")
            yield robot, name, replace(agent, controller=known[name])


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    of, only, who = given["of"], split_names(given["only"]), split_names(given["who"])
    found: dict[str, Any] = {"device": device(), "calls": CALLS[of], "block": BLOCK, "tasks": {}}
    for task, name, agent in methods(only) if of == "methods" else goals(only, who):
        row = measured(agent, CALLS[of]) | {"period": 1e3 * agent.spec.dt}
        found["tasks"].setdefault(task, {})[name] = row
        print(f"{task}, {name}: {row['processor']:.2f} ms, best {row['best']:.2f}", flush=True)
        Path(given["out"]).write_text(json.dumps(found, indent=1) + "\n")


def measured(agent: Agent, calls: int) -> dict[str, float]:
    """Milliseconds of a decision: median, 99%, and the fastest block by the processor's clock."""
    decide = Exploring(replace(agent, random_steps=0), 0)
    decide.take(jax.jit(lambda: agent.params(agent.init(jax.random.key(0))))())
    obs, each, blocks = np.zeros(agent.spec.obs, np.float32), [], []
    for _ in range(calls // BLOCK):
        busy = time.process_time()
        for _ in range(BLOCK):
            began = time.perf_counter()
            decide(obs, 100_000)
            each.append(1e3 * (time.perf_counter() - began))
        blocks.append(1e3 * (time.process_time() - busy) / BLOCK)
    return {
        "median": float(np.median(each)),
        "99%": float(np.quantile(each, 0.99)),
        "best": min(each),
        "processor": min(blocks),
    }


if __name__ == "__main__":
    command.run(main)
