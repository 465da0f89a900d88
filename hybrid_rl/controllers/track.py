"""Follow the reference in the observation: `controller` acts with the reference as its goal.

    goal = z(reference now),  hold: the action that leads to z(reference one decision later)

Source: thesis section 7.5; feed-forward is ours.
"""

from dataclasses import replace
from functools import partial
from typing import Annotated, Any, cast

from jax import Array

from hybrid_rl.fields import has, part
from hybrid_rl.protocols import BalancedEnv, Controller, GoalPolicy, Model
from hybrid_rl.types import Params, Spec


@part
class TrackController:
    """`controller`, whose policy aims at the reference instead of the equilibrium.

    world.reference(obs [o]) are the observations [o] that the robot should have, now and one
    decision later; their own reference entries are those of obs.
    """

    controller: Controller
    model: Model
    policy: GoalPolicy
    world: Annotated[BalancedEnv, has("reference", "needs an environment with a reference")]

    def init(self, spec: Spec) -> Any:
        """The initial state of the inner controller."""
        return self.controller.init(spec)

    def act(
        self, params: Params, state: Any, obs: Array, key: Array
    ) -> tuple[Array, Any, dict[str, Array]]:
        """Action [m], next state, metrics of the inner controller. The key is consumed."""
        now, after = (
            self.model.lift(params.model, x) for x in cast(Any, self.world).reference(obs)
        )

        step = partial(self.model.step, params.model)
        policy = self.policy.aim(params.policy, now, after, step)
        return self.controller.act(params._replace(policy=policy), state, obs, key)

    def greedy(self) -> "TrackController":
        """The same around the controller without exploration."""
        return replace(self, controller=self.controller.greedy())
