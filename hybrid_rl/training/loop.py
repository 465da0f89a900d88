"""Many learners in one compiled program: `vmap` over seeds around a loop over decisions.

The learners are sharded over the devices of the host and do not communicate. With an axis of K sets
of numbers there are those of all seeds for each set, one after another:

    axis = Axis.of([{"agent": one}, {"agent": other}])  # which differ in numbers alone
    axis.numbers                            # {"agent.learners.policy.discount": (0.99, 0.995)}
    axis.put(one, "agent", {"agent.learners.policy.discount": 0.995})  # equals `other`

Within a program the numbers [] are traced. A part checks its fields when it is made, for which
they must be known: each agent was checked on its own, and `put` makes parts without the checks.
"""

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, fields, is_dataclass
from functools import partial
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.sharding import Mesh, NamedSharding, PartitionSpec

from hybrid_rl.fields import choices, plain
from hybrid_rl.training.agent import Agent, AgentState, trace_once
from hybrid_rl.types import Params

Numbers = Mapping[str, Any]  # path in a tree of parts -> number
# On a CPU, YNNPACK, XLA's default, is slower than Eigen in matrix products and than XLA's own loops
# in the sums of layer norms, so it gets convolutions only, of which there are none. LLVM's higher
# levels take up to 60% longer, for programs that are no faster.
COMPILER_OPTIONS: dict[str, Any] = {
    "cpu": {
        "xla_cpu_experimental_ynn_fusion_type": "LIBRARY_FUSION_TYPE_INDIVIDUAL_CONVOLUTION",
        "xla_backend_optimization_level": 1,
    }
}

SEEDS = PartitionSpec("seeds")
METRICS = PartitionSpec(None, "seeds")
REPLICATED = PartitionSpec()


class DifferError(ValueError):
    """Trees of parts differ in more than numbers, at the path that it names."""


@dataclass(frozen=True)
class Axis:
    """K sets of numbers for one tree of parts; none, of which there is one, by default."""

    count: int = 1  # K
    numbers: Mapping[str, tuple[float, ...]] = field(default_factory=dict)  # path -> [K]
    names: tuple[str, ...] = ("",)  # [K] of the sets, for messages

    @classmethod
    def of(cls, trees: Sequence[Any], names: tuple[str, ...] = ()) -> "Axis":
        """The numbers in which K trees differ: parts, with mappings and tuples of parts.

        Raises:
            DifferError: if they differ in anything else, such as a whole number of a field that
                takes no others.
        """
        return cls(len(trees), dict(_differing(trees, "")), names or ("",) * len(trees))

    def put(self, node: Any, path: str, numbers: Numbers) -> Any:
        """The tree `node`, which is at `path`, with `numbers` [] in it."""
        ours = {name for name in numbers if f"{name}.".startswith(f"{path}.")}
        if not ours:
            return node
        if path in ours:
            return numbers[path]
        if isinstance(node, Mapping):
            return {name: self.put(each, f"{path}.{name}", numbers) for name, each in node.items()}
        if isinstance(node, (list, tuple)):
            each = (self.put(one, f"{path}.{i}", numbers) for i, one in enumerate(node))
            return type(node)(each)
        made = copy(node)
        for name in (each.name for each in fields(node)):
            value = self.put(getattr(node, name), f"{path}.{name}", numbers)
            object.__setattr__(made, name, value)
        return made


def _differing(nodes: Sequence[Any], path: str, kind: Any = float) -> Iterator[tuple[str, Any]]:
    """The paths at which trees have different numbers, and these; kind: type of the field."""
    first = nodes[0]
    if all(node is first for node in nodes):
        return
    if all(isinstance(node, (int, float)) and not isinstance(node, bool) for node in nodes):
        if len(set(nodes)) > 1:
            if float not in map(plain, choices(kind)):
                raise DifferError(path)
            yield path, tuple(map(float, nodes))
        return
    below = [_below(node) for node in nodes]
    same = all(type(node) is type(first) for node in nodes)
    same &= all([*each] == [*below[0]] for each in below)
    if not same or not (below[0] or all(np.array_equal(node, first) for node in nodes)):
        raise DifferError(path)
    for name, (_, kind) in below[0].items():
        inner = [each[name][0] for each in below]
        yield from _differing(inner, f"{path}.{name}".lstrip("."), kind)


def _below(node: Any) -> dict[str, tuple[Any, Any]]:
    """The values right below a node by name, each with the type of its field."""
    if is_dataclass(node):
        return {each.name: (getattr(node, each.name), each.type) for each in fields(node)}
    if isinstance(node, Mapping):
        return {str(name): (value, float) for name, value in node.items()}
    if isinstance(node, (list, tuple)):  # a list of numbers is no number
        return {str(i): (value, int) for i, value in enumerate(node)}
    return {}


@dataclass
class Loop:
    """Trains a learner per entry of `seeds`, at most `stride` rounds a call, in one program.

    A round is one decision in each of an agent's environments. The number of rounds of a call is an
    argument of the program, so that a remainder does not need another compilation.
    """

    agent: Agent
    seeds: tuple[int, ...]  # [S] of all learners, K times the same with an axis
    stride: int
    axis: Axis = field(default_factory=Axis)  # numbers of "agent"
    fault: Exception | None = field(default=None, init=False)  # that ends the run, once it is saved
    notes: ClassVar[tuple[str, ...]] = ()  # on a run that is resumed; none: it goes on bit for bit

    def cut_short(self) -> None:
        """A signal came: a call that waits for its environment ends early."""

    def close(self) -> None:
        """The run is over: an environment that moves by itself is stopped."""

    @property
    def mesh(self) -> Mesh:
        """The devices in use: as many as divide the learners evenly."""
        devices = jax.local_devices()
        count = max(n for n in range(1, len(devices) + 1) if len(self.seeds) % n == 0)
        return Mesh(np.array(devices[:count]), ("seeds",))

    @property
    def idle_note(self) -> str:
        """A note if the learners do not divide evenly among all devices; else empty."""
        used, count, learners = self.mesh.size, jax.local_device_count(), len(self.seeds)
        if used == count:
            return ""
        return f" {learners} learners divide evenly over {used} of its {count} devices only"

    def shard(self, f: Callable[..., Any], ins: Any, outs: Any, **options: Any) -> Any:
        """`jit(f)`, run on every device with its share of the learners."""
        run = jax.shard_map(f, mesh=self.mesh, in_specs=ins, out_specs=outs, check_vma=False)
        return jax.jit(run, **options)

    def on_devices(self, state: AgentState) -> AgentState:
        """`state` moved from the host to the devices."""
        return jax.device_put(state, NamedSharding(self.mesh, SEEDS))

    def with_learner(self, state: AgentState, number: int, learner: AgentState) -> AgentState:
        """`state` with learner `number` replaced by `learner` [...]; `state` is donated."""
        put = jax.jit(
            lambda all_, one: jax.tree.map(lambda x, y: x.at[number].set(y), all_, one),
            donate_argnums=0,
            out_shardings=NamedSharding(self.mesh, SEEDS),
        )
        return put(state, learner)

    @property
    def numbers(self) -> dict[str, Array]:
        """The numbers of the axis by path, of each learner [S]."""
        each = len(self.seeds) // self.axis.count
        return {
            path: jnp.repeat(jnp.array(values, jnp.float32), each)
            for path, values in self.axis.numbers.items()
        }

    def init(self) -> AgentState:
        """The stacked states [S, ...] before the first decision.

        They are placed as those of a checkpoint are, so that a resumed run has the same program.
        """
        program, *given = self._first()
        return self.on_devices(compile_lowered(program.lower(*given))(*given))

    def pretrained(self, state: AgentState) -> AgentState:
        """`state` [S, ...], donated, after the gradient steps before the first decision."""
        if not self.agent.pretrain:
            return state

        def one(state: AgentState) -> AgentState:
            return self._of(state.numbers).pretrained(state, jax.random.fold_in(state.key, 0))

        program = self.shard(jax.vmap(one), SEEDS, SEEDS, donate_argnums=0)
        return compile_lowered(program.lower(state))(state)

    def shapes(self) -> AgentState:
        """The shapes of the states [S, ...]."""
        return jax.eval_shape(*self._first())

    def _first(self) -> tuple[Any, Array, dict[str, Array]]:
        """The program of `init`, and its arguments."""
        keys = jnp.stack([jax.random.key(seed) for seed in self.seeds])

        def first(key: Array, numbers: dict[str, Array]) -> AgentState:
            return self._of(numbers).init(key).replace(numbers=numbers)

        return self.shard(jax.vmap(first), SEEDS, SEEDS), keys, self.numbers

    def params(self, state: AgentState) -> Params:
        """The parameters [S, ...] of all learners."""
        return jax.vmap(lambda one: self._of(one.numbers).params(one))(state)

    def step(self, state: AgentState, step: Array) -> tuple[AgentState, dict[str, Array]]:
        """A round of one learner, as `Agent.step`."""
        return self._of(state.numbers).step(state, step)

    def _of(self, numbers: dict[str, Array]) -> Agent:
        """The agent with numbers [] of the axis."""
        return self.axis.put(self.agent, "agent", numbers)

    def trace(self, state: AgentState) -> Any:
        """The trace of the program."""
        parts = (SEEDS, REPLICATED, REPLICATED), (SEEDS, METRICS)
        program = self.shard(self._advance, *parts, donate_argnums=0)
        zero = jnp.zeros((), jnp.int32)
        return program.trace(state, zero, zero)

    def compile(self, state: AgentState) -> Any:
        """The compiled program (state, first step, rounds) -> (state, metrics)."""
        return self.compile_trace(self.trace(state))

    def compile_trace(self, traced: Any) -> Any:
        """The compiled program of a trace."""
        return compile_lowered(traced.lower())

    def memory(self, program: Any) -> float:
        """Memory [bytes] per device of the compiled `program` and its state; 0 if unknown."""
        used = program.memory_analysis()
        if used is None:
            return 0.0
        arrays = used.argument_size_in_bytes + used.output_size_in_bytes - used.alias_size_in_bytes
        return float(arrays + used.temp_size_in_bytes)

    def _advance(
        self, state: AgentState, start: Array, rounds: Array
    ) -> tuple[AgentState, dict[str, Array]]:
        """The state after `rounds` rounds, and their metrics [:rounds] of [stride, S, ...]."""
        step = trace_once(jax.vmap(self.step, in_axes=(0, None)))
        shapes = self.rows_of(jax.eval_shape(step, state, start)[1])
        rows = jax.tree.map(jnp.zeros_like, shapes)

        def body(i: Array, carry: tuple[AgentState, Any]) -> tuple[AgentState, Any]:
            state, rows = carry
            state, metrics = step(state, start + i * self.agent.num_envs)
            return state, put(rows, metrics, i)

        return jax.lax.fori_loop(0, rounds, body, (state, rows))

    def rows_of(self, metrics: dict[str, Any]) -> dict[str, jax.ShapeDtypeStruct]:
        """The shapes [stride, S, ...] of the metrics of a call, of which a round has [S, ...]."""
        return {
            name: jax.ShapeDtypeStruct((self.stride, *metric.shape), metric.dtype)
            for name, metric in metrics.items()
        }


def compile_lowered(lowered: Any) -> Any:
    """The compiled program, with COMPILER_OPTIONS where XLA_FLAGS do not name them."""
    flags = os.environ.get("XLA_FLAGS", "")
    options = COMPILER_OPTIONS.get(jax.default_backend(), {})
    try:
        return lowered.compile({key: options[key] for key in options if key not in flags})
    except jax.errors.JaxRuntimeError as error:
        lacks = "No such compile option", "not a valid enum value"  # of another release of XLA
        if not any(line in str(error) for line in lacks):
            raise
        return lowered.compile()


def put(rows: dict[str, Array], metrics: dict[str, Array], i: Array) -> dict[str, Array]:
    """The rows with `metrics` [S, ...] in row i."""
    at = partial(jax.lax.dynamic_update_index_in_dim, index=i, axis=0)
    return rows | {name: at(rows[name], metric) for name, metric in metrics.items()}
