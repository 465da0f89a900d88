"""Expert for Panda: grasp the block, carry it above the base, and release it there.

    v = 2 (g - p), at most `speed` in each direction

Before the grasp p is the hand and g a point in a funnel above the block; after it p is the block
and g a point in a funnel above its target on the base. The funnel rises 4 cm per cm of horizontal
distance and ends 1 cm below the target, so that the approach does not slow down. A lift starts
slowly while the fingers move, and the block is carried above both blocks. With grip=action the
hand closes and opens within 8 mm. The expert uses only the observation, so that a policy can be
cloned from it.
"""

from typing import Literal

import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.panda_stack import SIDE, PandaStack
from hybrid_rl.fields import part
from hybrid_rl.types import Params, Spec

GAIN = 2.0  # [1/s]
NEAR = 0.008  # [m] at which the hand closes and opens
DEPTH = 0.01  # [m] of the funnel's end below the target
SLOPE = 4.0  # of the funnel
HEIGHT = 0.07  # [m] of the funnel
CLEARANCE = 0.04  # [m] height of a block above the table before it moves sideways
LIFT_SPEED = 0.02  # [m/s] at the beginning of a lift


@part
class StackController:
    """Acts on the observation of `panda_stack`; the fields are those of the environment."""

    base: tuple[float, float] = PandaStack.base  # [m] its position
    speed: float = PandaStack.speed  # [m/s] at a = 1
    grip: Literal["near", "action"] = PandaStack.grip
    observation: Literal["thesis", "stage"] = PandaStack.observation

    def init(self, spec: Spec) -> tuple[()]:
        """No state."""
        return ()

    def act(
        self, params: Params, state: tuple[()], obs: Array, key: Array
    ) -> tuple[Array, tuple[()], dict[str, Array]]:
        """Action [3] or, with grip=action, [4]; no state, no metrics; deterministic."""
        to_block, to_goal, height, closed = self._read(obs)
        held = closed & (jnp.linalg.norm(to_block) < SIDE / 2)
        remaining = jnp.where(held, to_goal, to_block)
        distance, lifted = jnp.linalg.norm(remaining[:2]), height - SIDE / 2
        above = jnp.clip(SLOPE * (distance - NEAR / 2), 0.0, HEIGHT) - DEPTH
        velocity = GAIN * remaining.at[2].add(above)
        lift = LIFT_SPEED + GAIN * jnp.where(held, lifted, jnp.maximum(-to_block[2], 0.0))
        carried = jnp.append(
            velocity[:2] * jnp.clip(lifted / CLEARANCE - 1, 0.0, 1.0),
            jnp.minimum(velocity[2], lift),
        )
        velocity = jnp.where(held & (distance > SIDE / 2), carried, velocity)
        error = jnp.abs(to_goal)
        stacked = (error < jnp.array([0.02, 0.02, 0.01])).all() & ~closed
        velocity = jnp.where(stacked, jnp.array([0.0, 0.0, 1.0]) * lift, velocity)
        action = jnp.clip(velocity / self.speed, -1.0, 1.0)
        if self.grip == "action":
            placed = (error[:2] < NEAR).all() & (error[2] < NEAR / 2)
            near = jnp.linalg.norm(to_block) < NEAR
            grip = jnp.where(closed, held & ~placed, near & ~stacked)
            action = jnp.append(action, jnp.where(grip, 1.0, -1.0))
        return action, (), {}

    def _read(self, obs: Array) -> tuple[Array, Array, Array, Array]:
        """Vectors hand to block and block to target [3], the block's height, whether closed []."""
        if self.observation == "stage":  # a closed hand holds the block; a high block is stacked
            closed, none = obs[3] > 0, jnp.zeros(3).at[2].set(1.5 * SIDE - obs[4])
            to_block, to_goal = jnp.where(closed, 0.0, obs[:3]), jnp.where(closed, obs[:3], none)
            return to_block, to_goal, obs[4], closed
        block, goal = obs[3:6], jnp.array([*self.base, 1.5 * SIDE])
        return block - obs[:3], goal - block, block[2], obs[6] > 0

    def greedy(self) -> "StackController":
        """This controller, which does not explore."""
        return self
