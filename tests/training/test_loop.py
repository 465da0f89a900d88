"""The compiled program of many decisions and its largest array, the replay memory."""

import math
import re
from collections import Counter
from dataclasses import replace

import jax
import jax.numpy as jnp
import pytest
from tiny import TINY

from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.learners.sac import SAC
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.settings import build as config
from hybrid_rl.training.loop import COMPILER_OPTIONS, Axis, DifferError, Loop, compile_lowered

# An instruction of a compiled program: "%name = f32[2,211,1,10]{3,2,1,0} copy(...".
INSTRUCTION = re.compile(r"(?m)^\s*(?:ROOT )?%?[\w.-]+ = (\w+)\[([\d,]*)\]\S* ([\w-]+)\(")
WRITES = {"dynamic-update-slice", "scatter"}  # of one row, in place
NAMES = {"parameter", "get-tuple-element", "bitcast", "fusion"}  # of an existing array


def operations(program, dtype, size):
    """How often each operation of a program returns an array of `size` numbers.

    Operations inside a fusion are counted separately, and so is the fusion itself.
    """
    counts = Counter()
    for kind, shape, operation in INSTRUCTION.findall(program):
        if kind == dtype and math.prod(map(int, filter(None, shape.split(",")))) == size:
            counts[operation] += 1
    return counts


def test_the_replay_memory_is_never_copied_and_a_resumed_run_finds_its_program():
    """One write of a row per decision, no other array of its size; the same from a checkpoint."""
    capacity = ["total_steps=20011", "replay.capacity=20011"]  # larger than any other array
    run = config.build(config.load([*TINY, "algo=sac", "num_seeds=2", *capacity]))
    loop = Loop(run.agent, run.seeds, stride=10)
    rows, fresh = loop.shapes().memory.rows, loop.init()
    placed = loop.on_devices(jax.device_get(jax.tree.map(jax.numpy.copy, fresh)))
    one, other = (loop.trace(state).lower() for state in (fresh, placed))
    assert one.as_text() == other.as_text()
    program = loop.compile(fresh)
    counts = operations(program.as_text(), "f32", rows.size)
    assert sum(counts[name] for name in WRITES) == 1
    assert set(counts) <= WRITES | NAMES, counts
    assert program.memory_analysis().temp_size_in_bytes < rows.size * 4 / 10


@pytest.mark.parametrize("lacks", [False, True])
def test_xla_flags_and_other_releases_of_xla_come_before_our_options(monkeypatch, lacks):
    given = []

    class Lowered:
        def compile(self, options=None):
            given.append(options)
            if options and lacks:
                raise jax.errors.JaxRuntimeError("No such compile option: 'xla_cpu_of_another'")
            return "compiled"

    ours = COMPILER_OPTIONS["cpu"]
    monkeypatch.setenv("XLA_FLAGS", "")
    assert compile_lowered(Lowered()) == "compiled"
    assert given == ([ours, None] if lacks else [ours])
    monkeypatch.setenv("XLA_FLAGS", " ".join(f"--{key}=0" for key in ours))
    assert compile_lowered(Lowered()) == "compiled"
    assert given[-1] == {}


ONE = SAC(TanhGaussian(hidden=(4,)), EnsembleQ(hidden=(4,)), discount=0.9)
OTHER = replace(ONE, policy=TanhGaussian(hidden=(4,), log_std_max=1.0), discount=0.95)


def test_the_numbers_that_differ_make_one_tree_the_other():
    trees = [{"a": (each, "word", 3)} for each in (ONE, OTHER)]
    axis = Axis.of(trees)
    assert axis.numbers == {"a.0.policy.log_std_max": (2.0, 1.0), "a.0.discount": (0.9, 0.95)}
    second = {path: values[1] for path, values in axis.numbers.items()}
    assert axis.put(trees[0]["a"], "a", second) == trees[1]["a"]
    assert axis.put(trees[0]["a"], "b", second) is trees[0]["a"]
    assert Axis.of([ONE, replace(ONE)]).numbers == {}


def test_a_part_with_a_traced_number_skips_the_check_of_its_field():
    axis = Axis.of([{"a": ONE}, {"a": OTHER}])
    doubled = jax.jit(lambda x: 2 * axis.put(ONE, "a", {"a.discount": x}).discount)
    assert doubled(jnp.float32(0.25)) == 0.5


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"batch_size": 3}, "batch_size"),
        ({"during_random": True}, "during_random"),
        ({"target_entropy": -1.0}, "target_entropy"),
        ({"policy": TanhGaussian(hidden=(5,))}, "policy.hidden.0"),
        ({"policy": TanhGaussian(hidden=(4, 4))}, "policy.hidden"),
        ({"critic": EnsembleQ(hidden=(4,), activation="tanh")}, "critic.activation"),
    ],
)
def test_what_is_no_number_is_refused_by_its_path(change, path):
    with pytest.raises(DifferError) as caught:
        Axis.of([ONE, replace(ONE, **change)])
    assert str(caught.value) == path


def test_a_whole_number_stands_for_a_number():
    assert Axis.of([ONE, replace(ONE, discount=0)]).numbers == {"discount": (0.9, 0.0)}
