"""Decisions per second of Gymnasium's half-cheetah on the host, beside ours in one program.

    taskset -c 0 python -m scripts.host_speed out=docs/results/host_speed.json
    python -m scripts.host_speed rows=overlap out=docs/results/host_overlap.json

One learner with settings=light, which learns; blocks of all rows take turns on one machine, and
count the processor's time, as others may use it. rows=overlap: by the clock, with
env.overlap=true and without; also where a step takes 3 ms more, and where nothing is learned then,
which is what overlap can reach at most.
"""

import json
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from gymnasium.envs.mujoco.half_cheetah_v5 import HalfCheetahEnv

from hybrid_rl import config as configuration
from hybrid_rl.cli.arguments import Argument, one_of, read
from hybrid_rl.run.jax_settings import prepare
from hybrid_rl.run.provenance import device
from hybrid_rl.training.loops import loop_of

CHEETAH = ["task=gymnasium", "env.id=HalfCheetah-v5"]
SLOW = ["task=gymnasium", "env.make=scripts.host_speed:Slow", "episode.steps=1000"]
BUSY = [*SLOW, "env.kwargs={busy: true}"]
OVERLAP, PROCESSES = "env.overlap=true", "env.processes=true"
NOTHING = "nothing learned"
TASKS = {
    "doors": {"native": ["task=halfcheetah", "physics=native"], "gymnasium": CHEETAH},
    "overlap": {
        "gymnasium": CHEETAH,
        "gymnasium, overlap": [*CHEETAH, OVERLAP],
        "waits": SLOW,
        "waits, overlap": [*SLOW, OVERLAP],
        "computes": BUSY,
        "computes, overlap": [*BUSY, OVERLAP],
        "computes, processes": [*BUSY, PROCESSES],
        "computes, processes, overlap": [*BUSY, PROCESSES, OVERLAP],
        NOTHING: [*SLOW, OVERLAP],
    },
}
ARGUMENTS = (
    Argument("rows", "doors", "what is compared", one_of(*TASKS)),
    Argument("out", "host_speed.json", "the numbers"),
)
METHODS = {  # words, decisions of a block, blocks
    "sac": (["algo=sac"], 400, 6),
    "hybrid_stochastic": (["algo=hybrid_stochastic"], 60, 4),
}
WARM, STRIDE = 400, 200
PAUSE_S = 0.003


class Slow(HalfCheetahEnv):
    """A half-cheetah whose step takes 3 ms more, in which it waits, or computes in Python."""

    def __init__(self, busy: bool = False) -> None:
        """busy: whether it computes."""
        super().__init__()
        self.busy = busy

    def step(self, action: Any) -> Any:
        """As Gymnasium's."""
        end = time.perf_counter() + PAUSE_S
        if not self.busy:
            time.sleep(PAUSE_S)
        while time.perf_counter() < end:
            pass
        return super().step(action)


class Contestant:
    """A learner that is past its random decisions."""

    def __init__(self, words: list[str], learns: bool, clock: Callable[[], float]) -> None:
        """Compile, and learn from the first decisions, if at all; clock: [s]."""
        self.clock = clock
        size = ["settings=light", "random_steps=100", "total_steps=20000"]
        config = configuration.load([*words, *size])
        prepare(config)
        run = configuration.build(config)
        agent = run.agent if learns else replace(run.agent, first_update=10**9)
        self.loop, self.step = loop_of(agent, run.seeds, STRIDE), 0
        self.state = self.loop.init()
        self.program = self.loop.compile(self.state)
        self.rate(WARM)

    def rate(self, decisions: int) -> float:
        """Decisions per second of so many more."""
        began, end = self.clock(), self.step + decisions
        while self.step < end:
            rounds = min(STRIDE, end - self.step)
            given = self.state, jnp.int32(self.step), jnp.int32(rounds)
            self.state, _ = self.program(*given)
            self.step += rounds
        jax.block_until_ready(self.state.key)
        return decisions / (self.clock() - began)

    def close(self) -> None:
        """End the environment, and its process."""
        if copies := getattr(self.program, "copies", None):
            copies.close()


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    tasks = TASKS[given["rows"]]
    clock = time.process_time if given["rows"] == "doors" else time.perf_counter
    found: dict[str, Any] = {"machine": device(), "rows": {}}
    for algo, (chosen, block, blocks) in METHODS.items():
        each = {
            name: Contestant([*words, *chosen], name != NOTHING, clock)
            for name, words in tasks.items()
        }
        rates: dict[str, list[float]] = {name: [] for name in tasks}
        for number in range(blocks):
            for name in list(tasks)[:: 1 if number % 2 else -1]:
                rates[name].append(round(each[name].rate(block), 1))
        found["rows"][algo] = rates
        medians = {name: float(np.median(values)) for name, values in rates.items()}
        print(f"{algo}: {medians}", flush=True)
        for one in each.values():
            one.close()
    Path(given["out"]).write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
