"""What the compiled program of many decisions does with its largest array."""

import math
import re
from collections import Counter

import jax
from tiny import TINY

from hybrid_rl import config
from hybrid_rl.training.loop import Loop

# An instruction of a compiled program: "%name = f32[2,211,1,10]{3,2,1,0} copy(...".
INSTRUCTION = re.compile(r"(?m)^\s*(?:ROOT )?%?[\w.-]+ = (\w+)\[([\d,]*)\]\S* ([\w-]+)\(")
WRITES = {"dynamic-update-slice", "scatter"}  # of one row, in place
NAMES = {"parameter", "get-tuple-element", "bitcast", "fusion"}  # of an array that is there


def operations(program, dtype, size):
    """How often each operation of a program has an array of `size` numbers for its result.

    Those of a fusion are counted one by one, and the fusion itself as such.
    """
    found = Counter()
    for kind, shape, operation in INSTRUCTION.findall(program):
        if kind == dtype and math.prod(map(int, filter(None, shape.split(",")))) == size:
            found[operation] += 1
    return found


def test_the_replay_memory_is_never_copied():
    """One write of a row for each decision, no array of its size beside it."""
    capacity = ["total_steps=20011", "replay.capacity=20011"]  # larger than all else
    run = config.build(config.load([*TINY, "algo=sac", "num_seeds=2", *capacity]))
    loop = Loop(run.agent, run.seeds, stride=10)
    rows = jax.eval_shape(loop.init).memory.rows
    program = loop.compile(loop.init())
    found = operations(program.as_text(), "f32", rows.size)
    assert sum(found[name] for name in WRITES) == 1
    assert set(found) <= WRITES | NAMES, found
    assert program.memory_analysis().temp_size_in_bytes < rows.size * 4 / 10
