"""The memory that a run needs, and that the machine has."""

import os
from typing import Any

import jax

from hybrid_rl.errors import UsageError
from hybrid_rl.settings.build import Run
from hybrid_rl.training.loop import Loop


def available() -> float:
    """Memory of a device [bytes]; of the machine if the CPU is the device."""
    stats = jax.local_devices()[0].memory_stats() or {}
    return stats.get("bytes_limit") or os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def check(loop: Loop, program: Any) -> None:
    """Raise MemoryError, with the number of learners that fit, if the program needs too much."""
    need, have, learners = loop.memory(program), available(), len(loop.seeds)
    if need > have:
        fit = int(learners * have / need)
        hint = f"about {fit} would fit" if fit else "lower num_envs, too"
        raise MemoryError(
            f"num_seeds={learners}: the program would take {need / 1e9:,.1f} GB of a device "
            f"and there are {have / 1e9:,.1f} GB; {hint}"
        )


def replay(run: Run, learners: int) -> str:
    """A line about the size of the replay memories of so many learners of a run."""
    replay, learned = run.agent.replay, run.agent.learners.items()
    batches = {name: one.batch_size for name, one in learned if one.data == "uniform"}
    largest = max(batches, key=batches.__getitem__, default="")
    each, have, flaw = replay.nbytes(run.agent.spec), available(), ""
    if batches and run.config.replay.capacity < batches[largest]:
        flaw = f"holds less than one batch, {largest}_learner.batch_size={batches[largest]}"
    elif each * learners > have:
        fits = int(0.5 * have / learners / (each / replay.capacity))
        flaw = f"{learners} learners would take {each * learners / 1e9:,.1f} GB and there are "
        flaw += f"{have / 1e9:,.1f} GB; {fits} would fit"
    if flaw:
        raise UsageError(f"replay.capacity={run.config.replay.capacity}: {flaw}")
    saved = "in checkpoints too" if run.config.checkpoint_replay else "not in checkpoints"
    return (
        f"replay memory: {replay.capacity:,} decisions, {each / 1e6:,.1f} MB a learner, "
        f"{each * learners / 1e6:,.1f} MB in all, {saved}"
    )
