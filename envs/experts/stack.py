"""Panda's expert, by hand, from what is observed alone: so that it can be cloned.

    v = 2 (g - p), at most `speed` in each direction

p is the hand and g lies in a funnel over the block; with the block in hand, p is the block and g
in a funnel over its place on the base. A funnel rises 4 cm for each cm to the side, and goes 1 cm
deeper than needed, so that nothing is approached ever more slowly. The hand lifts slowly at first,
while its fingers move, and carries above the blocks. Where the grip is an action, it closes and
opens within 8 mm.
"""

from dataclasses import dataclass

import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import Params, Spec

SIDE = 0.05  # [m] of a cube
GAIN = 2.0  # [1/s]
NEAR = 0.008  # [m] where the hand closes and opens
DEEP = 0.01  # [m] below what it approaches
SLOPE = 4.0  # of the funnel
ABOVE = 0.07  # [m] greatest height of the funnel
CLEAR = 0.04  # [m] from the table to a block that may go sideways
SLOW = 0.02  # [m/s] at which a lift begins


@dataclass(frozen=True)
class StackController:
    """Stacks by what `panda_stack` observes; the fields are that world's.

    Raises:
        ValueError: for a base that is not two numbers.
    """

    base: tuple[float, ...] = (0.45, 0.12)  # [m] where it stands, if it is not observed
    speed: float = 0.15  # [m/s] at full action
    grip: str = "near"  # or action

    def __post_init__(self) -> None:
        """Check the fields."""
        object.__setattr__(self, "base", tuple(self.base))
        if len(self.base) != 2:
            raise ValueError(f"expert.base={list(self.base)}: must be 2 numbers")

    def init(self, spec: Spec) -> tuple[()]:
        """Nothing: the expert has no memory."""
        return ()

    def act(
        self, params: Params, state: tuple[()], obs: Array, key: Array
    ) -> tuple[Array, tuple[()], dict[str, Array]]:
        """Action [3] or [4], no state, no metrics. There is no chance in it."""
        tool, block, closed = obs[:3], obs[3:6], obs[6] > 0
        goal = obs[13:] if obs.size > 13 else jnp.array([*self.base, 1.5 * SIDE])
        held = closed & (jnp.linalg.norm(block - tool) < SIDE / 2)
        left = jnp.where(held, goal - block, block - tool)
        aside, lifted = jnp.linalg.norm(left[:2]), block[2] - SIDE / 2
        height = jnp.clip(SLOPE * (aside - NEAR / 2), 0.0, ABOVE) - DEEP
        velocity = GAIN * left.at[2].add(height)
        lift = SLOW + GAIN * jnp.where(held, lifted, jnp.maximum(tool[2] - block[2], 0.0))
        carried = jnp.append(
            velocity[:2] * jnp.clip(lifted / CLEAR - 1, 0.0, 1.0), jnp.minimum(velocity[2], lift)
        )
        velocity = jnp.where(held & (aside > SIDE / 2), carried, velocity)
        there = jnp.abs(goal - block)
        stands = (there < jnp.array([0.02, 0.02, 0.01])).all() & ~closed
        velocity = jnp.where(stands, jnp.array([0.0, 0.0, 1.0]) * lift, velocity)
        action = jnp.clip(velocity / self.speed, -1.0, 1.0)
        if self.grip == "action":
            home = (there[:2] < NEAR).all() & (there[2] < NEAR / 2)
            near = jnp.linalg.norm(block - tool) < NEAR
            grip = jnp.where(closed, held & ~home, near & ~stands)
            action = jnp.append(action, jnp.where(grip, 1.0, -1.0))
        return action, (), {}

    def greedy(self) -> "StackController":
        """Itself."""
        return self
