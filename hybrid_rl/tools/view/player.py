"""One world and who acts in it, decision by decision; programs are exchanged between decisions.

Programs are made in a thread of their own. Until those of another mode, reward or body are ready,
the robot goes on as before; one that has nothing yet begins with its policy, which compiles in a
second or two, where a planner takes a minute.
"""

from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl import UsageError, rollout, scenery
from hybrid_rl.tools.view import programs
from hybrid_rl.tools.view.programs import Actor, Decision, Numbers, World
from hybrid_rl.tools.view.subject import Source, Subject
from hybrid_rl.types import EnvState, Params

EPISODES = 100  # of a seed that differ


@dataclass(frozen=True)
class Choice:
    """What is shown."""

    mode: str
    reward: str = ""  # of conf/reward; "": that of the training
    changes: Mapping[str, str] = field(default_factory=dict)  # env.KEY, episode.KEY -> value
    quick: bool = False  # whether a planner thinks less


@dataclass(frozen=True)
class Cast:
    """A choice with its programs."""

    choice: Choice
    subject: Subject
    world: World
    actor: Actor


class Player:
    """Plays `source`; `choose` changes who acts and where, `numbers` the goal."""

    def __init__(self, source: Source, params: Params, choice: Choice, seed: int) -> None:
        """Compile the first programs. `params` may be exchanged for those of a newer checkpoint."""
        self.source, self.params, self.numbers = source, params, Numbers()
        self.command = Numbers()  # by key of `Subject.commands`; empty: as the world decides
        self._made: dict[Any, Any] = {}  # programs that were compiled
        self._subjects: dict[Any, Subject] = {}
        self._pool = ThreadPoolExecutor(1, "compile")
        self._asked = choice
        self._coming: Future[Cast] | None = None
        self.problem = ""  # why the last choice is not shown
        subject = self._subject(choice)
        scenery.check_drawable(subject.episode.env)
        choice = replace(choice, mode=subject.named(choice.mode))
        quick = "policy" if "policy" in subject.controllers else choice.mode
        self.cast = self._make(replace(choice, mode=quick))
        self.begin(seed)
        self.choose(choice)

    @property
    def compiling(self) -> bool:
        """Whether programs of a choice are being made."""
        return self._coming is not None

    @property
    def modes(self) -> list[str]:
        """Modes of the present subject."""
        return list(self.cast.subject.controllers)

    def begin(self, seed: int, number: int = 0) -> None:
        """An episode begins: that of this number in the evaluation of learner `seed`."""
        key = rollout.evaluation_keys(seed, EPISODES)[number % EPISODES]
        start, self._key = jax.random.split(key)
        self.state: EnvState = self.cast.world.reset(start)
        self._control = self.cast.actor.begin()
        self.decided: Decision | None = None

    def forget_return(self) -> None:
        """Count the return from here on."""
        clock = self.state.clock
        self.state = self.state.replace(clock=clock._replace(total=jnp.zeros_like(clock.total)))

    def choose(self, choice: Choice) -> None:
        """Show this as soon as its programs are ready."""
        self.wanted, self.problem = choice, ""
        if choice != self.cast.choice and self._coming is None:
            self._ask()

    def advance(self) -> None:
        """One decision."""
        world, actor, subject = self.cast.world, self.cast.actor, self.cast.subject
        numbers = self._numbers(subject)
        self._key, now = jax.random.split(self._key)
        if self.command and world.commanded:
            command = [self.command.get(one.key, one.value) for one in subject.commands]
            self.state = world.commanded(self.state, jnp.array(command, jnp.float32))
        self.decided = actor.decide(self.params, numbers, self.state, self._control, now)
        self._control = self.decided.control
        self.state = world.step(numbers, self.state, self.decided.u)

    def close(self) -> None:
        """Wait for no program."""
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _numbers(self, subject: Subject) -> Numbers:
        """The numbers of the goals of `subject`: as chosen, else the defaults."""
        each = {one.key: self.numbers.get(one.key, one.value) for one in subject.goals}
        return {key: np.float32(value) for key, value in each.items()}

    def exchange(self) -> None:
        """Take programs that are ready, and ask for those that are wanted now."""
        ready = self._coming
        if ready is None or not ready.done():
            return
        self._coming = None
        try:
            self._enter(ready.result())
        except UsageError as error:  # it stays wanted, and is not asked for again
            self.problem = str(error)
        if self.wanted not in (self._asked, self.cast.choice):
            self.choose(self.wanted)

    def _ask(self) -> None:
        """Make the programs of what is wanted."""
        self._asked = self.wanted
        self._coming = self._pool.submit(self._make, self._asked)

    def _enter(self, cast: Cast) -> None:
        """Go on with other programs, from the state of the world as it is."""
        before, self.cast = self.cast, cast
        if cast.actor is not before.actor:
            self._control = cast.actor.begin()
        if cast.world is not before.world:
            leaves = jax.tree.leaves(self.state)
            like = jax.tree.leaves(jax.eval_shape(cast.world.episode.reset, jax.random.key(0)))
            if [leaf.shape for leaf in leaves] != [leaf.shape for leaf in like]:  # a delay, say
                start, self._key = jax.random.split(self._key)
                self.state = cast.world.reset(start)
                return
            self.state = jax.tree.unflatten(cast.world.structure, leaves)

    def _subject(self, choice: Choice) -> Subject:
        """The subject of a choice, read once; UsageError for a choice that does not fit."""
        key = choice.reward, tuple(sorted(choice.changes.items())), choice.quick
        if key not in self._subjects:
            self._subjects[key] = self.source.subject(choice.reward, choice.changes, choice.quick)
        return self._subjects[key]

    def _make(self, choice: Choice) -> Cast:
        """The programs of a choice; in a thread."""
        subject = self._subject(choice)
        choice = replace(choice, mode=subject.named(choice.mode))
        numbers = self._numbers(subject)
        where = choice.reward, tuple(sorted(choice.changes.items()))  # not the episode: one of
        if where not in self._made:  # the user's may hold a list, which has no hash
            self._made[where] = programs.world(subject.episode, numbers)
        world = self._made[where]
        plain = self._subject(replace(choice, changes={}))
        sees = subject.sees_world(choice.mode)
        who = choice.mode, choice.reward, choice.quick, where if sees else None
        if who not in self._made:
            acting = subject if sees else plain
            self._made[who] = programs.actor(acting, choice.mode, self.params, numbers)
        return Cast(choice, subject, world, self._made[who])
