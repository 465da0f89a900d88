"""The compiled program of many decisions and its largest array, the replay memory."""

import math
import re
from collections import Counter

import jax
import pytest
from tiny import TINY

from hybrid_rl.settings import build as config
from hybrid_rl.training.loop import COMPILER_OPTIONS, Loop, compile_lowered

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
