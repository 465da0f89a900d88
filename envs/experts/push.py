"""Sawyer's expert, by hand: round the block, then through it to the target.

    w = (t - b) / |t - b|;   behind the block: v = 0.1 w - 5 s (s . (e - b)), s across w
    elsewhere:               v = 3 (b - 0.07 w +- 0.08 s - e), |v| at most `speed`

e, b, t: rod's tip, block, target [m]. The action undoes the world's filter of velocities.
"""

from dataclasses import dataclass

import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import Params, Spec


@dataclass(frozen=True)
class PushController:
    """Pushes by what `sawyer_push` observes; the fields are that world's."""

    state_scale: float = 10.0  # of the observation [1/m]
    speed: float = 0.15  # [m/s] at full action
    smoothing: float = 0.8  # share of the last command that is kept

    def init(self, spec: Spec) -> Array:
        """The filtered velocity [2] [m/s]."""
        return jnp.zeros(2)

    def act(
        self, params: Params, state: Array, obs: Array, key: Array
    ) -> tuple[Array, Array, dict[str, Array]]:
        """Action [2], the filtered velocity [2], no metrics. There is no chance in it."""
        reach, left = jnp.split(obs / self.state_scale, 2)  # b - e, b - t
        way = -left / jnp.maximum(jnp.linalg.norm(left), 1e-6)
        side = jnp.stack((-way[1], way[0]))
        along, across = -reach @ way, -reach @ side
        pushing = (along < -0.03) & (jnp.abs(across) < 0.02)
        around = jnp.where(across < 0, -0.08, 0.08) * (along > -0.05)
        behind = 3 * (reach - 0.07 * way + around * side)
        velocity = jnp.where(pushing, 0.1 * way - 5 * across * side, behind)
        velocity *= jnp.minimum(1.0, self.speed / jnp.linalg.norm(velocity))
        kept = self.smoothing
        action = jnp.clip((velocity - kept * state) / ((1 - kept) * self.speed), -1.0, 1.0)
        return action, kept * state + (1 - kept) * self.speed * action, {}

    def greedy(self) -> "PushController":
        """Itself."""
        return self
