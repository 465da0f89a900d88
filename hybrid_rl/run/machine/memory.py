"""The memory that a run needs, and that the machine has."""

import os
from collections.abc import Iterable
from functools import partial
from typing import Any

import jax

from hybrid_rl.errors import UsageError
from hybrid_rl.protocols import Controller
from hybrid_rl.run.checkpoints.checkpoint import nbytes
from hybrid_rl.settings.build import Run
from hybrid_rl.training import rollout
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.loop import Loop

MANY = 10_000  # episodes; fewer always fit


def available() -> float:
    """Memory of a device [bytes]; of the machine if the CPU is the device."""
    stats = jax.local_devices()[0].memory_stats() or {}
    return stats.get("bytes_limit") or os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def check(loop: Loop, program: Any) -> None:
    """Raise MemoryError, with the number of learners that fit, if the program needs too much."""
    need, have = loop.memory(program), available()
    if need > have:
        learners, envs = len(loop.seeds), loop.agent.num_envs
        fit = int(learners * have / need)
        hint = f"about {fit} would fit" if fit else f"fewer than num_envs={envs} may fit"
        raise MemoryError(
            f"num_seeds={learners}: the program would take {need / 1e9:,.1f} GB of a device "
            f"and there are {have / 1e9:,.1f} GB; {hint}"
        )


def episodes(
    key: str, number: int, seeds: int, episode: Episode, controllers: Iterable[Controller]
) -> None:
    """Raise UsageError if the worlds of `number` episodes of each seed, side by side, do not fit.

    key: the argument that gave the number.
    """
    if number * seeds < MANY:
        return  # tracing the reset of a robot takes a second
    one = jax.eval_shape(lambda: jax.random.split(jax.random.key(0), 1))
    begun = (jax.eval_shape(partial(rollout.begin, episode, each), one) for each in controllers)
    sizes = map(nbytes, begun)
    need, have = max(sizes, default=0) * number * seeds, available()
    if need > have:
        raise UsageError(
            f"{key}={number}: their worlds would take {need / 1e9:,.1f} GB and there are "
            f"{have / 1e9:,.1f} GB"
        )


def replay(run: Run, learners: int) -> str:
    """A line about the size of the replay memories of so many learners of a run."""
    replay, learned = run.agent.replay, run.agent.learners.items()
    batches = {name: one.batch_size for name, one in learned if one.data == "uniform"}
    largest = max(batches, key=batches.__getitem__, default="")
    if batches and run.config.replay.capacity < batches[largest]:
        raise UsageError(
            f"replay.capacity={run.config.replay.capacity}: holds less than one batch, "
            f"{largest}_learner.batch_size={batches[largest]}"
        )
    each = replay.nbytes(run.agent.spec)
    have = available()
    if each * learners > have:
        fits = int(0.5 * have / learners / (each / replay.capacity))
        raise UsageError(
            f"replay.capacity={replay.capacity}: {learners} learners would take "
            f"{each * learners / 1e9:,.1f} GB and there are {have / 1e9:,.1f} GB; {fits} would fit"
            + (f", or num_seeds={int(have // each)}" if have > each else "")
        )
    saved = "in checkpoints too" if run.config.checkpoint_replay else "not in checkpoints"
    return (
        f"replay memory: {replay.capacity:,} decisions, {each / 1e6:,.1f} MB a learner, "
        f"{each * learners / 1e6:,.1f} MB in all, {saved}"
    )
