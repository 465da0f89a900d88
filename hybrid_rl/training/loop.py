"""Many learners in one compiled program: `vmap` over seeds around a loop over decisions.

The learners are dealt out over the devices of the host; none needs to hear of another.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from time import perf_counter
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.sharding import Mesh, NamedSharding, PartitionSpec

from hybrid_rl.training.agent import Agent, AgentState, trace_once

# On a CPU Eigen's matrix products take a sixth less time than those of YNNPACK, XLA's own choice.
COMPILER_OPTIONS: dict[str, Any] = {
    "cpu": {"xla_cpu_experimental_ynn_fusion_type": "LIBRARY_FUSION_TYPE_REDUCE"},
}

SEEDS = PartitionSpec("seeds")
ROWS = PartitionSpec(None, "seeds")
SAME = PartitionSpec()


@dataclass
class Loop:
    """Trains one learner per seed, at most `stride` rounds a call, compiled once.

    A round is one decision in each of an agent's worlds. The number of rounds of a call is an
    argument of the program, so that no odd remainder compiles again.
    """

    agent: Agent
    seeds: tuple[int, ...]
    stride: int
    compile_s: float = 0.0  # [s] spent compiling so far

    @property
    def mesh(self) -> Mesh:
        """The devices at work: as many of the host's as share the learners evenly."""
        devices = jax.local_devices()
        count = max(n for n in range(1, len(devices) + 1) if len(self.seeds) % n == 0)
        return Mesh(np.array(devices[:count]), ("seeds",))

    @property
    def idle(self) -> str:
        """What to say where the learners do not divide among the devices; else nothing."""
        used, there, learners = self.mesh.size, jax.local_device_count(), len(self.seeds)
        if used == there:
            return ""
        return f" {learners} learners divide evenly over {used} of its {there} devices only"

    def shard(self, f: Callable[..., Any], takes: Any, gives: Any, **how: Any) -> Any:
        """`jit(f)`, run on every device with its share of what has learners as an axis."""
        parts: Any = jax.shard_map(
            f, mesh=self.mesh, in_specs=takes, out_specs=gives, check_vma=False
        )
        return jax.jit(parts, **how)

    def place(self, state: AgentState) -> AgentState:
        """`state`, which was read from a file, on the devices."""
        return jax.device_put(state, NamedSharding(self.mesh, SEEDS))

    def replaced(self, state: AgentState, number: int, learner: AgentState) -> AgentState:
        """`state` with `learner` [...] in row `number`; the memory of `state` is used again."""
        put = jax.jit(
            lambda rows, row: jax.tree.map(lambda x, y: x.at[number].set(y), rows, row),
            donate_argnums=0,
            out_shardings=NamedSharding(self.mesh, SEEDS),
        )
        return put(state, learner)

    def init(self) -> AgentState:
        """The stacked states [S, ...] before the first decision."""
        keys = jnp.stack([jax.random.key(seed) for seed in self.seeds])
        return self.shard(jax.vmap(self.agent.init), SEEDS, SEEDS)(keys)

    def compile(self, state: AgentState) -> Any:
        """The program (state, first step, rounds) -> (state, metrics)."""
        began = perf_counter()
        parts = (SEEDS, SAME, SAME), (SEEDS, ROWS)
        program = self.shard(self._advance, *parts, donate_argnums=0)
        zero = jnp.zeros((), jnp.int32)
        lowered = program.lower(state, zero, zero)
        try:
            compiled = lowered.compile(COMPILER_OPTIONS.get(jax.default_backend()))
        except jax.errors.JaxRuntimeError as error:
            if "No such compile option" not in str(error):  # of another release of XLA
                raise
            compiled = lowered.compile()
        self.compile_s += perf_counter() - began
        return compiled

    def memory(self, program: Any) -> float:
        """[bytes] of a device that the compiled `program` takes, its state included; 0: unknown."""
        used = program.memory_analysis()
        if used is None:
            return 0.0
        arrays = used.argument_size_in_bytes + used.output_size_in_bytes - used.alias_size_in_bytes
        return float(arrays + used.temp_size_in_bytes)

    def _advance(
        self, state: AgentState, start: Array, rounds: Array
    ) -> tuple[AgentState, dict[str, Array]]:
        """State after `rounds` rounds, and metrics [stride, S, ...] of which these are filled."""
        step = trace_once(jax.vmap(self.agent.step, in_axes=(0, None)))
        shapes = jax.eval_shape(step, state, start)[1]
        rows = jax.tree.map(lambda m: jnp.zeros((self.stride, *m.shape), m.dtype), shapes)

        def body(i: Array, carry: tuple[AgentState, Any]) -> tuple[AgentState, Any]:
            state, rows = carry
            state, metrics = step(state, start + i * self.agent.num_envs)
            put = partial(jax.lax.dynamic_update_index_in_dim, index=i, axis=0)
            return state, jax.tree.map(lambda row, m: put(row, m), rows, metrics)

        return jax.lax.fori_loop(0, rounds, body, (state, rows))
