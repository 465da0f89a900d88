"""Milliseconds of a decision of the Fisher planner over the number of the model's weights.

    python thesis/scripts/fisher_ms.py --out docs/results/fisher_ms_cpu.json --cores 1
    python thesis/scripts/fisher_ms.py --out docs/results/fisher_ms_gpu.json --learners 64

One decision of algo=fisher on task=cart_swing_up (T = 20, 5 iterations), without learning, for
networks of two layers. `alone` is the planner without information. The time is the shortest and
the median of the repetitions, for all learners together.
"""

import argparse
import json
import os
from pathlib import Path
from time import perf_counter
from typing import Any

WIDTHS = {16: "436", 40: "2 k", 95: "10 k", 212: "47 k"}  # two layers -> weights
WAYS = {  # name -> overrides
    "alone": ["combined.weights.exploration=0.0"],
    "diagonal": ["information.criterion=D"],
    "probes": ["information.criterion=T", "information.probes=8"],
    "full": ["information.criterion=full"],
}


def one(width: int, way: str, learners: int, repeats: int) -> dict[str, Any]:
    """The times of one network and one way."""
    import jax
    import jax.numpy as jnp

    from hybrid_rl.settings import build as config

    given = ["task=cart_swing_up", "algo=fisher", f"model.hidden=[{width},{width}]", *WAYS[way]]
    if way == "alone":
        given = [*given[:3], "shooting_planner.objective=${objective}"]
    agent = config.build(config.load(given)).agent
    keys = jax.random.split(jax.random.key(0), learners)
    state = jax.jit(jax.vmap(agent.init))(keys)
    params = jax.vmap(agent.params)(state)
    obs = state.env.obs[:, 0]
    control = jax.tree.map(lambda x: x[:, 0], state.control)
    act = jax.jit(jax.vmap(lambda p, c, o, k: agent.controller.act(p, c, o, k)[:2]))
    began = perf_counter()
    program = act.lower(params, control, obs, keys).compile()
    compiled = perf_counter() - began
    times = []
    for _ in range(repeats + 2):
        began = perf_counter()
        u, control = jax.block_until_ready(program(params, control, obs, keys))
        times.append(1e3 * (perf_counter() - began))
    weights = params.model["weights"]["net"]
    return {
        "weights": sum(leaf[0].size for leaf in jax.tree.leaves(weights)),
        "way": way,
        "ms": round(min(times[2:]), 3),
        "median_ms": round(sorted(times[2:])[repeats // 2], 3),
        "compile_s": round(compiled, 1),
        "finite": bool(jnp.isfinite(u).all()),
    }


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description="Milliseconds of a decision")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--learners", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=20)
    parser.add_argument("--cores", type=int, default=0, help="of the CPU; 0: all")
    arguments = parser.parse_args()
    if arguments.cores:  # before JAX starts its threads
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: arguments.cores])
    import jax

    from hybrid_rl.run.machine.provenance import device

    rows = []
    for width in WIDTHS:
        for way in WAYS:
            rows.append(one(width, way, arguments.learners, arguments.repeats))
            print(rows[-1], flush=True)
            jax.clear_caches()
    numbers = {
        "device": device(),
        "cores": arguments.cores or None,
        "learners": arguments.learners,
        "horizon": 20,
        "iterations": 5,
        "state": 4,
        "rows": rows,
    }
    arguments.out.write_text(json.dumps(numbers, indent=1) + "\n")


if __name__ == "__main__":
    main()
