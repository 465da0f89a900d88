"""Milliseconds from an observation to an action, of policies and planners, on one core.

    taskset -c 0 python -m scripts.decision_ms out=docs/results/decision_ms.json

As the robot's process decides (training.decider.Decider), after a warm-up, with XLA in one thread.
Parameters are the first ones: the time does not depend on them.
"""

import json
import os
import time
from pathlib import Path
from typing import Any

os.environ["XLA_FLAGS"] = os.environ.get("XLA_FLAGS", "") + " --xla_cpu_multi_thread_eigen=false"

import jax
import numpy as np

from hybrid_rl import config as configuration
from hybrid_rl.cli.arguments import Argument, read
from hybrid_rl.run.provenance import device
from hybrid_rl.training.decider import Decider

ARGUMENTS = (Argument("out", "decision_ms.json", "the numbers"),)
CALLS = 500
METHODS = {
    "policy (settings=light)": ["algo=sac", "settings=light"],
    "policy": ["algo=sac"],
    "policy and planner (settings=light)": ["algo=hybrid_stochastic", "settings=light"],
    "policy and planner": ["algo=hybrid_stochastic"],
    "planner alone": ["algo=nn_mppi"],
    "deterministic hybrid": ["algo=hybrid_deterministic"],
}
TASKS = ("cartpole", "halfcheetah", "ant")


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    found: dict[str, Any] = {"device": device(), "calls": CALLS, "tasks": {}}
    for task in TASKS:
        found["tasks"][task] = {}
        for name, words in METHODS.items():
            agent = configuration.build(configuration.load([f"task={task}", *words])).agent
            decide = Decider(agent, 0, at_random=False)
            params = jax.jit(lambda agent=agent: agent.params(agent.init(jax.random.key(0))))()
            obs, each = np.zeros(agent.spec.obs, np.float32), []
            for _ in range(CALLS):
                began = time.perf_counter()
                decide(params, obs, 100_000)
                each.append(1e3 * (time.perf_counter() - began))
            row = {"median": float(np.median(each)), "99%": float(np.quantile(each, 0.99))}
            found["tasks"][task][name] = row
            print(f"{task}, {name}: {row['median']:.2f} ms, 99% below {row['99%']:.2f}", flush=True)
    Path(given["out"]).write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
