"""Where a decision's time goes: the whole loop, and the loop with parts left out.

python scripts/benchmark.py experiment=thesis/fig_3_2_halfcheetah algo=hybrid_stochastic

Prints decisions per second and milliseconds a decision: median of `ROUNDS` strides of
`STRIDE` decisions, compilation left out.
"""

import sys
from dataclasses import dataclass, replace
from statistics import median
from time import perf_counter

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl import config
from hybrid_rl.training import provenance
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.loop import Loop
from hybrid_rl.types import Params, Spec

STRIDE, ROUNDS, START = 500, 5, 100_000  # decisions, strides, decisions before (all parts learn)


@dataclass(frozen=True)
class Still:
    """Does nothing, at no cost."""

    actions: int

    def init(self, spec: Spec) -> tuple[()]:
        """Nothing."""
        return ()

    def act(
        self, params: Params, state: tuple, obs: Array, key: Array
    ) -> tuple[Array, tuple, dict]:
        """Half of full actuation."""
        return jnp.full(self.actions, 0.5), state, {}


def milliseconds(agent: Agent, seeds: tuple[int, ...]) -> tuple[float, float]:
    """[ms] a decision of every learner, and [s] of compilation."""
    loop = Loop(agent, seeds, STRIDE)
    state = loop.init()
    program = loop.compile(state)
    times = []
    for _ in range(ROUNDS + 1):  # the first warms up
        began = perf_counter()
        state, _ = program(state, jnp.int32(START), jnp.int32(STRIDE))
        jax.block_until_ready(state)
        times.append(1e3 * (perf_counter() - began) / STRIDE)
    return median(times[1:]), loop.compile_s


def main() -> None:
    """The command."""
    run = config.build(config.load(["total_steps=200000", *sys.argv[1:]]))
    agent, still = run.agent, Still(run.agent.spec.act)
    world = milliseconds(replace(agent, controller=still, learners={}), run.seeds)[0]
    whole, compile_s = milliseconds(agent, run.seeds)
    rows = {"whole loop": whole, "world and memory": world}
    for name, learner in agent.learners.items():
        with_one = replace(agent, controller=still, learners={name: learner})
        rows[f"{name} learner"] = milliseconds(with_one, run.seeds)[0] - world
    print(f"{run.config.task} {run.config.algo}, {len(run.seeds)} learners, {provenance.device()}")
    for name, value in rows.items():
        print(f"  {name:18} {value:8.3f} ms")
    print(f"  {'plan (the rest)':18} {2 * whole - sum(rows.values()):8.3f} ms")
    print(f"  {len(run.seeds) * 1e3 / whole:,.0f} decisions/s; compiled in {compile_s:.1f} s")


if __name__ == "__main__":
    main()
