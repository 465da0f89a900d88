"""u = u'(o'): a controller whose action acts late acts at the observation predicted for then.

    o_{j+1} = f(o_j, u_{j-k}),   j = 0 ... k-1,   o' = o_k     u_j: sent, u_{-1} last

The mean of the model rolls the newest observation forward over the k actions that are pending:
sent, and not acting yet. A history of observations (`core.history`) gets what is predicted, too. So
model, policy, critic and plans are those of the undelayed robot, if transitions hold the action
that acted, and another lag needs no learning. Of a part of a decision a model of whole ones says
nothing, so an action is held back until it acts whole decisions after its observation
(`wrappers.whole`). Without a model, as in `sac`, nothing is predicted.

Source: Derman et al. 2021, "Acting in delayed environments with non-stationary Markov policies";
Agarwal and Aggarwal 2021. Held back: arXiv 2507.18992, a conservative agent for random delays.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import history, lifting
from hybrid_rl.fields import Count, NotNegative, part
from hybrid_rl.networks.precision import using
from hybrid_rl.protocols import Controller, Model
from hybrid_rl.protocols.contract import parts
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.wrappers import whole
from hybrid_rl.types import Params, Spec


class AheadState(NamedTuple):
    """What was sent, and the inner controller's state."""

    sent: Array  # [K + 1, m] the last actions, the newest last
    lag: Array  # [] [decisions] from an observation until its action acts
    inner: Any


@part
class AheadController:
    """`controller`, which acts where the model says that the robot is when its action acts."""

    controller: Controller
    model: Model
    spec: Spec  # of single observations
    lag: NotNegative = 0.0  # [decisions] from an observation until its action acts, rounded
    most: Count = 1  # K [decisions] longest lag that is predicted

    def init(self, spec: Spec) -> AheadState:
        """Actions of 0 were sent."""
        inner = self.controller.init(spec)
        return AheadState(jnp.zeros((self.most + 1, spec.act)), jnp.float32(self.lag), inner)

    def act(
        self, params: Params, state: AheadState, obs: Array, key: Array
    ) -> tuple[Array, AheadState, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        world = lifting.is_world(self.model)
        now = lifting.start(self.model, params, obs) if world else obs
        there = self.predicted(params, state, now)
        if world:
            params, there = params._replace(world=there), there.obs
        u, inner, metrics = self.controller.act(params, state.inner, there, key)
        return u, remembered(state._replace(inner=inner), u), metrics

    def predicted(self, params: Params, state: AheadState, seen: Any) -> Any:
        """The observation at which an action that is sent at `seen` begins to act, in float32.

        Of a world model both are states of the world.
        """

        def later(j: Array, seen: Any) -> Any:
            u = _acting(state, self.most + 1 + j)
            if lifting.is_world(self.model):
                return self.model.step(params.model, seen, u)
            x = self.model.step(params.model, self.model.lift(params.model, seen), u)
            return history.shifted(seen, u, x[: self.spec.obs], self.spec.dt)

        with using("float32"):
            return jax.lax.fori_loop(0, jnp.round(state.lag).astype(int), later, seen)

    def greedy(self) -> "AheadController":
        """The controller without exploration, at the same states."""
        return replace(self, controller=self.controller.greedy())


def remembered(state: Any, u: Array) -> Any:
    """The state after u [m] was sent; any other controller's as it is."""
    if not isinstance(state, AheadState):
        return state
    return state._replace(sent=jnp.concatenate((state.sent[1:], u[None])))


def acted(state: Any, u: Array) -> Array:
    """The action [m] that acts while u [m], which was sent last, is on its way."""
    return _acting(state, len(state.sent) - 1) if isinstance(state, AheadState) else u


def _acting(state: AheadState, now: int | Array) -> Array:
    """The action [m] that acts while `sent[now]` is on its way, perhaps a later one."""
    acting = now - jnp.round(state.lag).astype(int)
    return state.sent[jnp.clip(acting, 0, len(state.sent) - 1)]


def ahead(controller: Controller, spec: Spec, lag: float, most: int = 0) -> Controller:
    """`controller`, at predicted states if it has a model and there is a `lag` [decisions].

    spec: of single observations. most: [decisions] longest lag, if it may change. A controller that
    has another lag gets this one.
    """
    if isinstance(controller, AheadController):
        controller = controller.controller
    models = (inner for _, name, _, inner in parts(controller) if name == "model")
    model, most = next(models, None), max(most, round(lag))
    return (
        controller
        if model is None or not most
        else AheadController(controller, model, spec, lag, most)
    )


def acting_ahead(
    episode: Episode, controllers: Mapping[str, Controller], most: int = 0
) -> tuple[Episode, dict[str, Controller]]:
    """The controllers, each `ahead` by what is known of the episode's lag, and the episode.

    If none predicts anything nothing is known, so that no action is held back.
    """
    longest = int(whole(episode.longest / episode.spec.dt)) if episode.knows_lag else 0
    lag, most = episode.known_lag, max(most, longest)
    acting = {mode: ahead(each, episode.spec, lag, most) for mode, each in controllers.items()}
    if episode.late and not any(isinstance(each, AheadController) for each in acting.values()):
        episode = replace(episode, lag=0.0)
    return episode, acting
