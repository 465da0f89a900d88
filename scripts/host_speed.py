"""Decisions per second of Gymnasium's environments on the host, beside ours in one program.

    python -m scripts.host_speed out=docs/results/host_speed.json
    python -m scripts.host_speed rows=waits out=docs/results/host_waits.json

One learner with settings=light, which learns; blocks of all rows take turns on one machine, and
of all turns the quietest ones count, in which other programs took the least of the processors. A
block has its seconds of the clock, and those of the processors that this program took.
rows=waits: Gymnasium's half-cheetah as it is, and where a step takes 3 ms more; learning after a
step, meanwhile as in every run, and nothing learned, which is what `meanwhile` can reach at most.
"""

import json
import os
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from gymnasium.envs.mujoco.half_cheetah_v5 import HalfCheetahEnv

from hybrid_rl.cli.arguments import Argument, one_of, read
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.run.machine.provenance import device
from hybrid_rl.run.members import loop_of
from hybrid_rl.settings import build as configuration

IDS = {"halfcheetah": "HalfCheetah-v5", "hopper": "Hopper-v5", "pendulum": "Pendulum-v1"}
SLOW = ["task=gymnasium", "env.make=scripts.host_speed:Slow", "episode.steps=1000"]
BUSY = [*SLOW, "env.kwargs={busy: true}"]
AFTER, NOTHING = "after", "nothing learned"  # what ends the name of a row
WAITS = {
    "gymnasium": ["task=gymnasium", "env.id=HalfCheetah-v5"],
    "waits": SLOW,
    "computes": BUSY,
    "computes, processes": [*BUSY, "env.processes=true"],
}
COMPARED = {  # comparisons -> rows -> words
    "doors": {
        task: {
            "native": [f"task={task}", "physics=native"],
            "gymnasium": ["task=gymnasium", f"env.id={name}"],
        }
        for task, name in IDS.items()
    },
    "waits": {
        "halfcheetah": {
            **{f"{row}{end}": words for row, words in WAITS.items() for end in ("", f", {AFTER}")},
            f"waits, {NOTHING}": SLOW,
        }
    },
}
ARGUMENTS = (
    Argument("rows", "doors", "what is compared", one_of(*COMPARED)),
    Argument("out", "host_speed.json", "the numbers"),
)
METHODS = {"sac": 300, "hybrid_stochastic": 40}  # decisions of a block
KINDS = (  # of a block
    "clock",  # [1/s] decisions
    "processor",  # [1/s] of the time of all its threads
    "python",  # [us] of the main thread for a decision: the environment, and calls of the program
    "others",  # processors that other programs took
)
TURNS, QUIETEST = {"doors": 30, "waits": 6}, 10
WARM, STRIDE = 400, 200
PAUSE_S = 0.003


class Slow(HalfCheetahEnv):
    """A half-cheetah whose step takes 3 ms more, in which it waits, or computes in Python."""

    def __init__(self, busy: bool = False) -> None:
        """busy: whether it computes."""
        super().__init__()
        self.busy = busy

    def step(self, action: Any) -> Any:
        """Gymnasium's step, later."""
        end = time.perf_counter() + PAUSE_S
        if not self.busy:
            time.sleep(PAUSE_S)
        while time.perf_counter() < end:
            pass
        return super().step(action)


class Contestant:
    """A learner that is past its random decisions."""

    def __init__(self, name: str, words: list[str]) -> None:
        """Compile, and learn from the first decisions, if at all; name: of the row."""
        size = ["settings=light", "random_steps=100", "total_steps=20000"]
        config = configuration.load([*words, *size])
        prepare(config)
        run = configuration.build(config)
        agent = replace(run.agent, first_update=10**9) if name.endswith(NOTHING) else run.agent
        self.loop, self.step = loop_of(agent, run.seeds, STRIDE), 0
        if name.endswith(AFTER):
            self.loop.early = False
        self.state = self.loop.init()
        self.program = self.loop.compile(self.state)
        self.block(WARM)

    def block(self, decisions: int) -> np.ndarray:
        """KINDS of so many more."""
        began, end = _now(), self.step + decisions
        while self.step < end:
            rounds = min(STRIDE, end - self.step)
            given = self.state, jnp.int32(self.step), jnp.int32(rounds)
            self.state, _ = self.program(*given)
            self.step += rounds
        jax.block_until_ready(self.state)
        clock, processor, python, machine = _now() - began
        rates = decisions / clock, decisions / processor
        return np.array([*rates, 1e6 * python / decisions, (machine - processor) / clock])

    def close(self) -> None:
        """End the environment, and its process."""
        if copies := getattr(self.program, "copies", None):
            copies.close()


def _now() -> np.ndarray:
    """Seconds [4]: of the clock; of this program, its main thread, and all programs."""
    jiffies = list(map(int, Path("/proc/stat").read_text().split(None, 9)[1:9]))
    busy = (sum(jiffies) - jiffies[3] - jiffies[4]) / os.sysconf("SC_CLK_TCK")
    return np.array([time.perf_counter(), time.process_time(), time.thread_time(), busy])


def compare(rows: dict[str, list[str]], algo: str, count: int) -> dict[str, Any]:
    """KINDS of each row in the quietest of `count` turns."""
    each = {name: Contestant(name, [*words, f"algo={algo}"]) for name, words in rows.items()}
    turns = []
    for number in range(count):
        names = list(rows)[:: 1 if number % 2 else -1]
        turns.append({name: each[name].block(METHODS[algo]) for name in names})
    for one in each.values():
        one.close()
    turns.sort(key=lambda turn: max(block[-1] for block in turn.values()))
    blocks = {name: np.array([turn[name] for turn in turns[:QUIETEST]]) for name in rows}
    return {
        name: dict(zip(KINDS, np.round(found.T, 2).tolist(), strict=True))
        for name, found in blocks.items()
    }


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    found: dict[str, Any] = {"machine": device(), "rows": {}}
    for task, rows in COMPARED[given["rows"]].items():
        for algo in METHODS:
            found["rows"][f"{task} {algo}"] = rates = compare(rows, algo, TURNS[given["rows"]])
            medians = {
                name: [float(np.median(v)) for v in rate.values()] for name, rate in rates.items()
            }
            print(f"{task} {algo}: {medians}", flush=True)
    Path(given["out"]).write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
