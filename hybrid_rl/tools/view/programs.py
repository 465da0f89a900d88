"""The compiled programs of a window: a first state, a decision, a step of the world.

The decision and the step are two programs, so that another body needs no other planner.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl import Episode, PhysicsState, scenery
from hybrid_rl.protocols import Controller
from hybrid_rl.tools.view import imagined
from hybrid_rl.tools.view.subject import Subject, with_goals
from hybrid_rl.types import Considered, EnvState, Params

Numbers = dict[str, Any]  # group.KEY of a goal -> value []


class Decision(NamedTuple):
    """What a controller decides in one state."""

    u: Array  # [m]
    control: Any  # its next state
    metrics: dict[str, Array]
    drawn: Array | None  # [K, ...] of the candidates, for `imagined.lines`; None: nothing
    chosen: Array  # [] the candidate that acts


@dataclass(frozen=True)
class World:
    """The programs of an environment."""

    episode: Episode
    reset: Callable[[Array], EnvState]  # of a key
    step: Callable[[Numbers, EnvState, Array], EnvState]
    pose: Callable[[EnvState], Array]  # [nq]
    structure: Any  # of its states
    commanded: Callable[[EnvState, Array], EnvState] | None  # by `Subject.commands` [k]


@dataclass(frozen=True)
class Actor:
    """The program of a controller.

    One that sees only observations serves every body: it gets the state of the world, for drawing,
    as one of the environment that it was compiled with.
    """

    begin: Callable[[], Any]  # its state when an episode begins
    program: Callable[[Params, Numbers, EnvState, Any, Array], Decision]
    like: EnvState  # shapes of the states that it gets
    sees: bool  # the whole state

    def decide(
        self, params: Params, numbers: Numbers, state: EnvState, control: Any, key: Array
    ) -> Decision:
        """What it decides in `state`."""
        seen = _bare(state, self.like)
        if not self.sees:
            seen = jax.tree.unflatten(jax.tree.structure(self.like), jax.tree.leaves(seen))
        return self.program(params, numbers, seen, control, key)


def _bare(state: EnvState, like: EnvState) -> EnvState:
    """`state` with only the memory, the metrics and the own fields of the model that `like` has."""
    info, data = {name: state.info[name] for name in like.info}, state.data
    if isinstance(data, PhysicsState):
        held = None if like.data.held is None else data.held
        own = {name: data.fields[name] for name in like.data.fields}
        data = data.replace(fields=own, held=held)
    metrics = {name: state.metrics[name] for name in like.metrics}
    clock = None
    if like.clock is not None:
        clock = type(like.clock)(
            *(None if own is None else x for own, x in zip(like.clock, state.clock, strict=True))
        )
    return state.replace(data=data, info=info, metrics=metrics, clock=clock)


def world(episode: Episode, numbers: Numbers) -> World:
    """Compile an environment; numbers: of its goals, with any values."""

    def step(numbers: Numbers, state: EnvState, u: Array) -> EnvState:
        return with_goals(episode, episode, numbers).step(state, u)

    key = jax.random.key(0)
    like = jax.eval_shape(episode.reset, key)
    u = jax.ShapeDtypeStruct((episode.spec.act,), jnp.float32)
    env: Any = episode.env
    commanded = None
    if commands := Subject(episode, {}, frozenset()).commands:
        commanded = jax.jit(env.commanded).lower(like, jnp.zeros(len(commands))).compile()
    return World(
        episode,
        jax.jit(episode.reset).lower(key).compile(),
        jax.jit(step).lower(_arrays(numbers), like, u).compile(),
        jax.jit(scenery.pose_of(episode.env)).lower(like).compile(),
        jax.tree.structure(like),
        commanded,
    )


def actor(subject: Subject, mode: str, params: Params, numbers: Numbers) -> Actor:
    """Compile who acts in `mode`, with any parameters and numbers."""
    episode, controllers, sees = subject.episode, subject.controllers, subject.sees_world(mode)
    along = imagined.of_policy(episode, controllers, mode)
    read = imagined.reading(episode)

    def decide(
        params: Params, numbers: Numbers, state: EnvState, control: Any, key: Array
    ) -> Decision:
        controller = with_goals(controllers[mode], episode, numbers)
        seen = params._replace(world=state) if sees else params
        u, control, metrics, found = considered(controller, seen, control, state.obs, key)
        if found is None and along is not None:
            found = Considered(along(params, state.obs), jnp.zeros((), jnp.int32))
        drawn, chosen = None, jnp.zeros((), jnp.int32)
        if found is not None:
            first = jax.tree.map(lambda leaf: leaf[: imagined.MOST], found.paths)
            drawn, chosen = imagined.seen(read, episode.env, state, first), found.chosen
        return Decision(u, control, metrics, drawn, chosen)

    key, resting = jax.random.key(0), controllers[mode].init
    begin = jax.jit(lambda: resting(episode.spec)).lower().compile()
    control = jax.eval_shape(lambda: resting(episode.spec))
    state = jax.eval_shape(episode.reset if sees else episode.env.reset, key)
    program = jax.jit(decide).lower(params, _arrays(numbers), state, control, key).compile()
    return Actor(begin, program, state, sees)


def considered(
    controller: Controller, params: Params, control: Any, obs: Array, key: Array
) -> tuple[Array, Any, dict[str, Array], Considered | None]:
    """Action, next state, metrics, and the candidates if the controller has any."""
    planner: Any = controller
    if hasattr(planner, "considered"):
        return planner.considered(params, control, obs, key)
    return *controller.act(params, control, obs, key), None


def _arrays(numbers: Numbers) -> Numbers:
    return {key: jnp.float32(value) for key, value in numbers.items()}
