"""Panda's expert, by hand: above the block, down, close, up, above the base, down, open, up.

    v = 3 (g - e), at most `speed` in each direction;   the next goal g once |g - e| < 6 mm

e: point between the fingertips. The hand waits for six decisions while it closes and opens.
The action undoes the world's filter of velocities.
"""

from dataclasses import dataclass
from math import exp

import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import Params, Spec

SIDE = 0.05  # [m] of a cube
ABOVE = 0.1  # [m] over what it goes down to
HIGH = 0.15  # [m] where it carries
NEAR = 0.006  # [m] from a goal
WAIT = 6  # decisions for the fingers
CLOSE, OPEN, LAST = 2, 6, 7  # of the eight phases


@dataclass(frozen=True)
class StackController:
    """Stacks by what `panda_stack` observes; the fields are that world's.

    Raises:
        ValueError: for a base that is not two numbers.
    """

    base: tuple[float, ...] = (0.45, 0.12)  # [m] where it stands, if it is not observed
    speed: float = 0.15  # [m/s] at full action
    lag: float = 0.2  # [s] of the filter; 0: none

    def __post_init__(self) -> None:
        """Check the fields."""
        object.__setattr__(self, "base", tuple(self.base))
        if len(self.base) != 2:
            raise ValueError(f"expert.base={list(self.base)}: must be 2 numbers")

    def init(self, spec: Spec) -> tuple[Array, Array, Array, Array]:
        """Phase [], decisions in it [], filtered velocity [3] [m/s], share kept of it []."""
        kept = exp(-spec.dt / self.lag) if self.lag else 0.0
        zero = jnp.zeros((), jnp.int32)
        return zero, zero, jnp.zeros(3), jnp.float32(kept)

    def act(
        self, params: Params, state: tuple[Array, ...], obs: Array, key: Array
    ) -> tuple[Array, tuple[Array, ...], dict[str, Array]]:
        """Action [4], the next state, no metrics. There is no chance in it."""
        phase, waited, held, kept = state
        tool, block = obs[:3], obs[3:6]
        goal = obs[13:] if obs.size > 13 else jnp.array([*self.base, 1.5 * SIDE])
        up, high = jnp.array([0.0, 0.0, ABOVE]), tool.at[2].set(HIGH)
        goals = jnp.stack([block + up, block, tool, high, goal + up, goal, tool, goal + up])
        error = goals[phase] - tool
        still = (phase == CLOSE) | (phase == OPEN)
        done = jnp.where(still, waited >= WAIT, jnp.linalg.norm(error) < NEAR)
        velocity = jnp.clip(3 * error, -self.speed, self.speed)
        action = jnp.clip((velocity - kept * held) / ((1 - kept) * self.speed), -1.0, 1.0)
        held = kept * held + (1 - kept) * self.speed * action
        grip = jnp.where((phase >= CLOSE) & (phase < OPEN), 1.0, -1.0)
        after = jnp.where(done, jnp.minimum(phase + 1, LAST), phase)
        state = after, jnp.where(done, 0, waited + 1), held, kept
        return jnp.append(action, grip), state, {}

    def greedy(self) -> "StackController":
        """Itself."""
        return self
