"""Decisions per second of Gymnasium's half-cheetah on the host, beside ours in one program.

    taskset -c 0 python -m scripts.host_speed out=docs/results/host_speed.json

One learner with settings=light, which learns; blocks of both take turns on one machine.
"""

import json
import time
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl import config as configuration
from hybrid_rl.cli.arguments import Argument, read
from hybrid_rl.run.jax_settings import prepare
from hybrid_rl.run.provenance import device
from hybrid_rl.training.loops import loop_of

ARGUMENTS = (Argument("out", "host_speed.json", "the numbers"),)
TASKS = {
    "native": ["task=halfcheetah", "physics=native"],
    "gymnasium": ["task=gymnasium", "env.id=HalfCheetah-v5"],
}
BLOCKS = {"sac": (400, 6), "hybrid_stochastic": (60, 4)}  # decisions of a block, blocks
WARM, STRIDE = 400, 200


class Contestant:
    """A learner that is past its random decisions."""

    def __init__(self, words: list[str]) -> None:
        """Compile, and learn from the first decisions."""
        size = ["settings=light", "random_steps=100", "total_steps=20000"]
        config = configuration.load([*words, *size])
        prepare(config)
        run = configuration.build(config)
        self.loop, self.step = loop_of(run.agent, run.seeds, STRIDE), 0
        self.state = self.loop.init()
        self.program = self.loop.compile(self.state)
        self.rate(WARM)

    def rate(self, decisions: int) -> float:
        """Decisions per second of so many more."""
        began, end = time.perf_counter(), self.step + decisions
        while self.step < end:
            rounds = min(STRIDE, end - self.step)
            given = self.state, jnp.int32(self.step), jnp.int32(rounds)
            self.state, _ = self.program(*given)
            self.step += rounds
        jax.block_until_ready(self.state.key)
        return decisions / (time.perf_counter() - began)


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    found: dict[str, Any] = {"machine": device(), "rows": {}}
    for algo, (block, blocks) in BLOCKS.items():
        each = {name: Contestant([*words, f"algo={algo}"]) for name, words in TASKS.items()}
        rates: dict[str, list[float]] = {name: [] for name in TASKS}
        for number in range(blocks):
            for name in list(TASKS)[:: 1 if number % 2 else -1]:
                rates[name].append(round(each[name].rate(block), 1))
        found["rows"][algo] = rates
        medians = {name: float(np.median(values)) for name, values in rates.items()}
        print(f"{algo}: {medians}, {medians['gymnasium'] / medians['native']:.2f}", flush=True)
    Path(given["out"]).write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
