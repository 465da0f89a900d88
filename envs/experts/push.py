"""Expert for Sawyer: move around the block, then push it to the target.

    w = (t - b) / |t - b|, s perpendicular to w
    behind the block   v = 0.1 w - 5 s (s . (e - b))
    elsewhere          v = 3 (b - 0.07 w +- 0.08 s - e), |v| <= speed

e, b, t: tip of the rod, block, target [m]. The action inverts the environment's velocity filter.
"""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.sawyer_push import SawyerPush
from hybrid_rl.fields import part
from hybrid_rl.types import Params, Spec


@part
class PushController:
    """Acts on the positions of `sawyer_push`; the fields are those of the environment."""

    state_scale: float = SawyerPush.state_scale  # of the observation [1/m]
    speed: float = SawyerPush.speed  # [m/s] at a = 1
    smoothing: float = SawyerPush.smoothing  # weight of the previous command in the filter

    def init(self, spec: Spec) -> Array:
        """The filtered velocity [2] [m/s]."""
        return jnp.zeros(2)

    def act(
        self, params: Params, state: Array, obs: Array, key: Array
    ) -> tuple[Array, Array, dict[str, Array]]:
        """Action [2], filtered velocity [2], no metrics; deterministic."""
        reach, remaining = jnp.split(obs[:4] / self.state_scale, 2)  # b - e, b - t
        direction = -remaining / jnp.maximum(jnp.linalg.norm(remaining), 1e-6)
        side = jnp.stack((-direction[1], direction[0]))
        along, across = -reach @ direction, -reach @ side
        pushing = (along < -0.03) & (jnp.abs(across) < 0.02)
        around = jnp.where(across < 0, -0.08, 0.08) * (along > -0.05)
        behind = 3 * (reach - 0.07 * direction + around * side)
        velocity = jnp.where(pushing, 0.1 * direction - 5 * across * side, behind)
        velocity *= jnp.minimum(1.0, self.speed / jnp.linalg.norm(velocity))
        keep = self.smoothing
        action = jnp.clip((velocity - keep * state) / ((1 - keep) * self.speed), -1.0, 1.0)
        return action, keep * state + (1 - keep) * self.speed * action, {}

    def greedy(self) -> "PushController":
        """This controller, which does not explore."""
        return self
