"""Learners that reach NaN or infinity: each one ends, and the others of its program go on."""

from collections.abc import Mapping, Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.run.store import Store
from hybrid_rl.training.loop import Loop

End = dict[str, Any]  # {"seed", "step", "quantity"} of a learner that diverged


class Diverged:
    """The learners of `loop` that have ended.

    The program computes all learners together, so that one that has ended goes through the
    motions; `mended` gives it back the state of its last good checkpoint, or its first one.
    """

    def __init__(self, loop: Loop, store: Store) -> None:
        self.loop, self.store = loop, store
        self.ends: dict[int, End] = {}  # by the learner's number
        self._whole: dict[int, Any] = {}  # its state then

    @property
    def steps(self) -> dict[int, int]:
        """Learner -> the step at which it ended."""
        return {s: end["step"] for s, end in self.ends.items()}

    @property
    def left(self) -> int:
        """Learners that go on."""
        return len(self.loop.seeds) - len(self.ends)

    def add(self, found: Mapping[int, tuple[int, str]]) -> list[End]:
        """The ends that were not known; found: learner -> (step, quantity)."""
        new = {
            s: {"seed": self.loop.seeds[s], "step": step, "quantity": quantity}
            for s, (step, quantity) in sorted(found.items())
            if s not in self.ends
        }
        self.ends |= new
        return list(new.values())

    def resume(self, ends: Sequence[End]) -> None:
        """Take up what a checkpoint knew."""
        self.ends = {self.loop.seeds.index(end["seed"]): end for end in ends}

    def mended(self, state: Any) -> Any:
        """`state`, whose memory is used again, with sound rows for learners that have ended."""
        for s in self.ends:
            if s not in self._whole:
                self._whole[s] = self.store.learner(s)
            state = self.loop.replaced(state, s, self._whole[s])
        return state


def unsound(learners: Any, step: int) -> dict[int, tuple[int, str]]:
    """Learner -> (step, name) of a learned number [S, ...] that is not finite."""
    found: dict[int, tuple[int, str]] = {}
    for path, leaf in jax.tree_util.tree_leaves_with_path(learners):
        if jnp.issubdtype(leaf.dtype, jnp.floating):
            numbers = np.asarray(leaf)
            for s in np.flatnonzero(~np.isfinite(numbers.reshape(len(numbers), -1)).all(1)):
                name = jax.tree_util.keystr(path, simple=True, separator=".")
                found.setdefault(int(s), (step, name))
    return found


def said(end: End, left: int) -> str:
    """That a learner ended, while `left` others go on."""
    others = "the other learner goes" if left == 1 else f"the other {left} learners go"
    return f"{_words(end)}; it ends here, {others} on"


def line(ends: Sequence[End], left: int, checkpoint: int | None) -> str:
    """What happened and what can be done, in one line.

    left: learners that went on; checkpoint: the step of the newest one.
    """
    each = "; ".join(_words(end) for end in ends)
    if left:
        others = "the other learner" if left == 1 else f"the other {left} learners"
        return f"{each}; {others} went on to the end"
    advice = "begin again with a lower learning rate"
    if checkpoint is None:
        return f"{each}; there is no checkpoint: {advice}"
    return f"{each}; checkpoint {checkpoint} is whole: evaluate or resume it, or {advice}"


def _words(end: End) -> str:
    return f"seed {end['seed']}, step {end['step']}: {end['quantity']} is not finite"
