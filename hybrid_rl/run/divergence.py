"""Learners that reach NaN or infinity: each one ends, and the others of its program continue.

Where the world returned such a number, the message shows its decision, from the replay memory.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.run.checkpoints.store import End
from hybrid_rl.run.logs.rows import ACTION, of_world
from hybrid_rl.run.shelf import Shelf
from hybrid_rl.training.loop import Loop

BY_ACTING = ("eval/", ACTION)  # begin quantities that sound learners may make infinite


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
        """Learners that go on."""
        return len(self.loop.seeds) - len(self.ends)

    def add(
        self, failures: Mapping[int, tuple[int, str]], state: Any = None, now: int = 0
    ) -> dict[int, End]:
        """The new ends; failures: learner -> (step, quantity); state: [S, ...], at step `now`."""
        new = {
            s: {"seed": self.loop.seeds[s], "step": step, "quantity": quantity, **self._of(s)}
            for s, (step, quantity) in sorted(failures.items())
            if s not in self.ends
        }
        for s, end in new.items():
            if of_world(end["quantity"]):
                end["world"] = self._decision(s, end, state, now)
            elif end["quantity"].startswith(BY_ACTING) and s not in unsound(state.learners, now):
                blame = "the world's rewards and the controller's actions"
                end["world"] = f"all that was learned is finite: see {blame}"
        self.ends |= new
        return new

    def _of(self, s: int) -> dict[str, str]:
        """The name of the numbers of learner s, if there are others."""
        axis = self.loop.axis
        name = axis.names[s * axis.count // len(self.loop.seeds)]
        return {"of": name} if name else {}

    def _decision(self, s: int, end: End, state: Any, now: int) -> str:
        """What the world of learner s returned at `end`, if the memory still holds it."""
        agent, memory = self.loop.agent, jax.tree.map(lambda leaf: leaf[s], state.memory)
        made = agent.replay.recent(memory, agent.spec, (now - end["step"]) // agent.num_envs)
        if made is None:
            return f"a fault of the world {_class_of(agent.episode.env)}"
        sound = np.isfinite(made.reward) & np.isfinite(made.next_obs).all(-1)
        e = int(np.argmin(sound))  # the environment
        obs, action, reward, after = (
            np.array2string(np.asarray(each[e]), precision=4, threshold=8, separator=", ")
            for each in (made.obs, made.action, made.reward, made.next_obs)
        )
        of_reward = np.isfinite(made.next_obs[e]).all() and agent.episode.reward is not None
        name = _class_of(agent.episode.reward if of_reward else agent.episode.env)
        what = f"at obs {obs}, action {action} gives reward {reward}, obs {after}"
        return " ".join(f"a fault of the world: {name} {what}".split())

    def repaired(self, state: Any) -> Any:
        """`state`, whose buffers are reused, with sound values for learners that have ended."""
        for s in self.ends:
            if s not in self._sound:
                self._sound[s] = self.shelf.learner(s)
            state = self.loop.with_learner(state, s, self._sound[s])
        return state


def _class_of(part: Any) -> str:
    return f"{type(part).__module__}.{type(part).__name__}"


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


def note(end: End, left: int) -> str:
    """A line for a learner that ended while `left` others continue."""
    others = "the other learner continues" if left == 1 else f"the other {left} learners continue"
    return f"{_words(end)}; it ends here, {others}"


def line(ends: Sequence[End], left: int, checkpoint: int | None) -> str:
    """The failure and what can be done, in one line.

    left: learners that went on; checkpoint: the step of the newest one.
    """
    each = "; ".join(_words(end) for end in ends)
    if left:
        others = "the other learner" if left == 1 else f"the other {left} learners"
        return f"{each}; {others} went on to the end"
    of_learning = not any("world" in end for end in ends)
    advice = "begin again with a lower learning rate"
    if checkpoint is None:
        return f"{each}; there is no checkpoint" + (f": {advice}" if of_learning else "")
    mend = f"evaluate or resume it, or {advice}" if of_learning else "mend the world and resume it"
    return f"{each}; checkpoint {checkpoint} is whole: {mend}"


def _words(end: End) -> str:
    who = f"seed {end['seed']}" + (f" of {end['of']}" if "of" in end else "")
    line = f"{who}, step {end['step']}: {end['quantity']} is not finite"
    return f"{line}, {end['world']}" if "world" in end else line
