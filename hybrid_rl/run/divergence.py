"""Learners that reach NaN or infinity: each one ends, and the others of its program continue."""

from collections.abc import Mapping, Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.run.checkpoints.store import End, Shelf
from hybrid_rl.training.loop import Loop


class Diverged:
    """The learners of `loop` that have ended.

    The program computes all learners together, so one that has ended is still computed; `repaired`
    gives it the state of its last sound checkpoint, or its initial state.
    """

    def __init__(self, loop: Loop, shelf: Shelf) -> None:
        self.loop, self.shelf = loop, shelf
        self.ends: dict[int, End] = {}  # by the learner's number
        self._sound: dict[int, Any] = {}  # the state that replaces its own

    @property
    def steps(self) -> dict[int, int]:
        """Learner -> the step at which it ended."""
        return {s: end["step"] for s, end in self.ends.items()}

    @property
    def left(self) -> int:
        """Learners that continue."""
        return len(self.loop.seeds) - len(self.ends)

    def add(self, failures: Mapping[int, tuple[int, str]]) -> dict[int, End]:
        """The new ends; failures: learner -> (step, quantity)."""
        new, axis, seeds = {}, self.loop.axis, self.loop.seeds
        for s, (step, quantity) in sorted(failures.items()):
            if s in self.ends:
                continue
            new[s] = {"seed": seeds[s], "step": step, "quantity": quantity}
            if numbers := axis.names[s * axis.count // len(seeds)]:  # where there are others
                new[s]["of"] = numbers
        self.ends |= new
        return new

    def repaired(self, state: Any) -> Any:
        """`state`, whose buffers are reused, with sound values for learners that have ended."""
        for s in self.ends:
            if s not in self._sound:
                self._sound[s] = self.shelf.learner(s)
            state = self.loop.with_learner(state, s, self._sound[s])
        return state


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
