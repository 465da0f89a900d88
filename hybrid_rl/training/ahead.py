"""u = u'(o'): a controller whose action acts late acts at the observation predicted for then.

    x_{j+1} = x_j + g_j (f(x_j, a_j) - x_j),   g_j = clip(lag - j, 0, 1),   o' = x_K's observation
    a_j = share u_{j-w-1} + (1 - share) u_{j-w},   lag = w + share          u_i: sent, u_{-1} last

The mean of the model rolls the newest observation forward over the actions that are pending, those
that were sent and have not acted yet; of a fraction of a decision, by a straight line. So model,
policy, critic and plans are those of the undelayed robot, if transitions hold the action that
acted, and another lag needs no learning. Without a model, as in `sac`, nothing is predicted.

Source: Derman et al. 2021, "Acting in delayed environments with non-stationary Markov policies";
Agarwal and Aggarwal 2021.
"""

import math
from dataclasses import replace
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import lifting
from hybrid_rl.fields import Count, NotNegative, part
from hybrid_rl.protocols import Controller, Model
from hybrid_rl.protocols.contract import parts
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
    lag: NotNegative = 0.0  # [decisions] from an observation until its action acts
    most: Count = 1  # K [decisions] longest lag that is predicted

    def init(self, spec: Spec) -> AheadState:
        """Actions of 0 were sent."""
        inner = self.controller.init(spec)
        return AheadState(jnp.zeros((self.most + 1, spec.act)), jnp.float32(self.lag), inner)

    def act(
        self, params: Params, state: AheadState, obs: Array, key: Array
    ) -> tuple[Array, AheadState, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        x = self.predicted(params, state, lifting.start(self.model, params, obs))
        if lifting.is_world(self.model):
            params = params._replace(world=x)
        there = lifting.policy_input(x)[: obs.size]
        u, inner, metrics = self.controller.act(params, state.inner, there, key)
        return u, remembered(state._replace(inner=inner), u), metrics

    def predicted(self, params: Params, state: AheadState, x: Any) -> Any:
        """The planning state at which an action that is sent at x begins to act."""
        for j in range(self.most):
            after = self.model.step(params.model, x, _acting(state, self.most + 1 + j))
            gone = jnp.clip(state.lag - j, 0, 1)
            x = jax.tree.map(lambda a, b, gone=gone: _between(a, b, gone), x, after)
        return x

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


def _acting(state: AheadState, now: int) -> Array:
    """The action [m] that acts while `sent[now]` is on its way, perhaps a later one."""
    whole = jnp.floor(state.lag)
    share, at, last = state.lag - whole, now - whole.astype(int), len(state.sent) - 1
    older, newer = (state.sent[jnp.clip(at - i, 0, last)] for i in (1, 0))
    return share * older + (1 - share) * newer


def _between(a: Array, b: Array, share: Array) -> Array:
    """a + share (b - a); what is no real number is that of the nearer end."""
    if not jnp.issubdtype(a.dtype, jnp.floating):
        return jnp.where(share < 0.5, a, b)
    return jnp.where(share > 0, a + share * (b - a), a)


def ahead(controller: Controller, lag: float, most: int = 0) -> Controller:
    """`controller`, at predicted states if it has a model and there is a `lag` [decisions].

    most: [decisions] longest lag, if it may change. One that has another lag gets this one.
    """
    if isinstance(controller, AheadController):
        controller = controller.controller
    models = (inner for _, name, _, inner in parts(controller) if name == "model")
    model, most = next(models, None), max(most, math.ceil(lag))
    return (
        controller if model is None or not most else AheadController(controller, model, lag, most)
    )
