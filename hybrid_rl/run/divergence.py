"""Learners that reach NaN or infinity: each one ends, and the others of its program continue."""

from collections.abc import Mapping, Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.run.checkpoints.store import End
from hybrid_rl.training.loop import Loop


def new_ends(
    loop: Loop, known: Mapping[int, End], failures: Mapping[int, tuple[int, str]]
) -> dict[int, End]:
    """The ends, by the learner's number, that are not yet `known`.

    failures: learner -> (step, quantity).
    """
    new: dict[int, End] = {}
    for s, (step, quantity) in sorted(failures.items()):
        if s not in known:
            new[s] = {"seed": loop.seeds[s], "step": step, "quantity": quantity}
            if numbers := loop.axis.names[s * loop.axis.count // len(loop.seeds)]:
                new[s]["of"] = numbers  # where there are others
    return new


def unsound(learners: Any, step: int) -> dict[int, tuple[int, str]]:
    """Learner -> (step, name) of a learned number [S, ...] that is not finite."""
    failures: dict[int, tuple[int, str]] = {}
    for path, leaf in jax.tree_util.tree_leaves_with_path(learners):
        if jnp.issubdtype(leaf.dtype, jnp.floating):
            numbers = np.asarray(leaf)
            for s in np.flatnonzero(~np.isfinite(numbers.reshape(len(numbers), -1)).all(1)):
                name = jax.tree_util.keystr(path, simple=True, separator=".")
                failures.setdefault(int(s), (step, name))
    return failures


def note(end: End) -> str:
    """A line for a learner that ended while others continue."""
    return f"{_words(end)}; it ends here, the others continue"


def line(ends: Sequence[End], left: int, checkpoint: int | None) -> str:
    """The failure and what can be done, in one line.

    left: learners that reached the end; checkpoint: the step of the newest one.
    """
    words = "; ".join(map(_words, ends))
    if left:
        return f"{words}; the others went on to the end"
    if checkpoint is None:
        return f"{words}; there is no checkpoint"
    mend = "fix what fails and resume it, or begin again with a lower learning rate"
    return f"{words}; checkpoint {checkpoint} is intact: {mend}"


def _words(end: End) -> str:
    who = f"seed {end['seed']}" + (f" of {end['of']}" if "of" in end else "")
    return f"{who}, step {end['step']}: {end['quantity']} is not finite"
