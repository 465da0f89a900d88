"""A model in the frame of an object, of which the task gives the heading a(x).

    y = R(-a) x,   v = R(-a) u,   x' = R(a) f(y, v),   a = a(x)

R(a) turns the whole scene by a. Where the dynamics are the same in several directions, a push in
one of them teaches those in the others; an object of several equal sides is turned until one of
them faces the robot, so that one side teaches the others. What does not turn with the scene stays
in x as it is: it is an input of the networks, or it is not modelled, as the limits of a workspace.
The gradient takes a as a constant.

Source: frames that move with the state make any function equivariant (Puny et al. 2022, Frame
Averaging, section 2, with one frame); as a model of dynamics our choice.
"""

from typing import Annotated, Any, cast

import jax
from jax import Array

from hybrid_rl.fields import has, part
from hybrid_rl.protocols import Trainable
from hybrid_rl.types import Spec

HEADLESS = "has no heading; choose task=sawyer_push, or model=ensemble"


@part
class Turned:
    """`model`, a single one or an ensemble, in the frames of `world`, whose R(a) turns a scene.

    heading(obs [o])            direction [] of an object, to which R(a) adds a
    turned(obs [o], a)          R(a) obs; what the dynamics depend on in the world may stay
    turned_action(u [m], a)     R(a) u
    """

    model: Trainable
    world: Annotated[Any, has("heading", HEADLESS)]

    @property
    def members(self) -> int:
        """Models in the ensemble."""
        return self.model.members

    def init(self, key: Array, spec: Spec) -> Any:
        """Initial parameters. The key is consumed."""
        return self.model.init(key, spec)

    def lift(self, params: Any, obs: Array) -> Array:
        """The observation [o] itself."""
        return obs

    def observe(self, params: Any, obs: Array, next_obs: Array) -> Any:
        """Parameters with statistics, in the frame, of observations [B, o] and successors."""

        def one(obs: Array, after: Array) -> tuple[Array, Array]:
            a = self.world.heading(obs)
            return self.world.turned(obs, -a), self.world.turned(after, -a)

        return self.model.observe(params, *jax.vmap(one)(obs, next_obs))

    def step(self, params: Any, x: Array, u: Array) -> Array:
        """Mean of the next planning state [n]."""
        a, y, v = self._into(x, u)
        return self.world.turned(self.model.step(params, y, v), a)

    def draw(self, params: Any, x: Array, u: Array, noise: Array, key: Array) -> Array:
        """Next states [B, n] for noise [B, n] ~ N(0, I) in the frame. The key is consumed."""
        a, y, v = jax.vmap(self._into)(x, u)
        return jax.vmap(self.world.turned)(self.model.draw(params, y, v, noise, key), a)

    def predictions(self, params: Any, x: Array, u: Array) -> tuple[Array, Array, Array]:
        """Mean of the next planning state [n], `disagreement` [n], every member's [members, n]."""
        a, *at = self._into(x, u)
        mean, disagreement, each = cast(Any, self.model).predictions(params, *at)
        turned = self.world.turned
        return turned(mean, a), disagreement, jax.vmap(turned, (0, None))(each, a)

    def disagreement(self, params: Any, x: Array, u: Array) -> Array:
        """Standard deviation [n] of the members in the frame, in running std of the change."""
        return cast(Any, self.model).disagreement(params, *self._into(x, u)[1:])

    def loss(self, params: Any, obs: Array, action: Array, next_obs: Array, key: Array) -> Array:
        """Mean loss [] of transitions [members * B, ...]. The key is consumed."""

        def one(x: Array, u: Array, after: Array) -> tuple[Array, Array, Array]:
            a, y, v = self._into(x, u)
            return y, v, self.world.turned(after, -a)

        return self.model.loss(params, *jax.vmap(one)(obs, action, next_obs), key)

    def _into(self, x: Array, u: Array) -> tuple[Array, Array, Array]:
        """The heading [] at x [n], and x and u [m] in its frame."""
        a = jax.lax.stop_gradient(self.world.heading(x))
        return a, self.world.turned(x, -a), self.world.turned_action(u, -a)
