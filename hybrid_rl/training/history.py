"""u = u'(s): a controller that acts by what it saw and did lately, s of `core.history`.

It remembers that by itself, so worlds, robots and loops outside give it the newest observation
alone; the replay memory makes the same s of its rows. Around it nothing is larger than before.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import history
from hybrid_rl.fields import Count, part
from hybrid_rl.protocols import Controller
from hybrid_rl.training import ahead
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Params, Spec


class HistoryState(NamedTuple):
    """What was seen at the last decision, what acted since, and the inner controller's state."""

    s: Array  # [n]
    u: Array  # [m]
    dt: Array  # [] [s] between decisions
    begun: Array  # [] bool: there was a decision in this episode
    inner: Any


@part
class HistoryController:
    """`controller`, which sees the last `history` observations and the actions between them."""

    controller: Controller
    history: Count

    def init(self, spec: Spec) -> HistoryState:
        """Nothing was seen yet."""
        seen = history.seen(spec, self.history)
        s, u, begun = jnp.zeros(seen.obs), jnp.zeros(spec.act), jnp.zeros((), bool)
        return HistoryState(s, u, jnp.float32(spec.dt), begun, self.controller.init(seen))

    def act(
        self, params: Params, state: HistoryState, obs: Array, key: Array
    ) -> tuple[Array, HistoryState, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        s = _at(state, obs)
        u, inner, metrics = self.controller.act(params, state.inner, s, key)
        return u, _after(state, s, u, inner), metrics

    def greedy(self) -> "HistoryController":
        """The controller without exploration, with the same memory."""
        return replace(self, controller=self.controller.greedy())


def _at(state: HistoryState, obs: Array) -> Array:
    """s [n] at obs [o]."""
    later = history.shifted(state.s, state.u, obs, state.dt)
    return jnp.where(state.begun, later, history.first(obs, later.size))


def _after(state: HistoryState, s: Array, u: Array, inner: Any) -> HistoryState:
    """The state after u [m] was sent at s [n]."""
    return state._replace(s=s, u=ahead.acted(inner, u), begun=jnp.ones((), bool), inner=inner)


def remembered(state: Any, obs: Array, u: Array) -> Any:
    """A controller's state after another one sent u [m] at obs [o]."""
    if not isinstance(state, HistoryState):
        return ahead.remembered(state, u)
    return _after(state, _at(state, obs), u, ahead.remembered(state.inner, u))


def acted(state: Any, u: Array) -> Array:
    """The action [m] that acts while u [m], which was sent last, is on its way."""
    return state.u if isinstance(state, HistoryState) else ahead.acted(state, u)


def informed(state: Any, sent: Array, lag: Array) -> Any:
    """A controller's state if `sent` [K + 1, m] or more acts `lag` decisions late, newest last."""
    if isinstance(state, HistoryState):
        inner = informed(state.inner, sent, lag)
        return state._replace(u=ahead.acted(inner, sent[-1]), inner=inner)
    if not isinstance(state, ahead.AheadState):
        return state
    return state._replace(sent=sent[-len(state.sent) :], lag=lag)


def acting(
    episode: Episode, controllers: Mapping[str, Controller], most: int = 0
) -> tuple[Episode, dict[str, Controller]]:
    """As `acting_ahead`, and by the episode's history; also of those that act in other episodes."""
    inner = {
        mode: each.controller if isinstance(each, HistoryController) else each
        for mode, each in controllers.items()
    }
    episode, acting = ahead.acting_ahead(episode, inner, most)
    k = episode.history
    if k == 1:
        return episode, acting
    return episode, {mode: HistoryController(each, k) for mode, each in acting.items()}
