"""p(y = 1 | s) = lo + (hi - lo) sigmoid((r + w - d(s)) / w): the map of known objects.

d is the signed distance of the world's objects in their reference arrangement, and r the radius of
the robot: a robot in contact is at d = r, so that the step lies a width w outside.
"""

from functools import cache
from typing import Annotated, Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.fields import Inside, Positive, check_span, has, part

OUTLINE, GRID = 256, 64  # points of the outline; starts a side of its search
NEWTON, NEAR = 20, 1e-4  # iterations; |d - r| of a solution, in the box's shorter side


@part
class KnownMap:
    """The map of a world whose objects are known: a plane with a round robot.

    The world has the robot's `radius` and the plane's `low` and `high` [m], and distance(s [2]) is
    the signed distance [] [m] to the nearest object, at rest where they are listed.
    """

    world: Annotated[Any, has("distance", "needs contacts")]
    width: Positive = 0.008  # w [m]
    low: Inside = 0.01  # lo: at least twice the sensor's rate of false contacts
    high: Inside = 0.99  # hi

    def __post_init__(self) -> None:
        check_span(self)

    @property
    def middle(self) -> tuple[float, float]:
        """c: the middle of the map's box [m]."""
        (a, b), (c, d) = self.world.low, self.world.high
        return (a + c) / 2, (b + d) / 2

    @property
    def outline(self) -> np.ndarray:
        """Positions [M, 2] of the robot in contact."""
        return _outline(self.world)

    def chance(self, s: Array) -> Array:
        """p(y = 1) [] at s [2]."""
        inside = (self.world.radius + self.width - self.world.distance(s)) / self.width
        return self.low + (self.high - self.low) * jax.nn.sigmoid(inside)


@cache
def _outline(world: Any) -> np.ndarray:
    """Positions [M, 2] at d = r, by Newton's method from a grid."""
    with jax.ensure_compile_time_eval():
        sides = [jnp.linspace(a, b, GRID) for a, b in zip(world.low, world.high, strict=True)]
        s = jnp.stack(jnp.meshgrid(*sides), -1).reshape(-1, 2)
        step = jax.vmap(jax.value_and_grad(world.distance))
        for _ in range(NEWTON):
            d, slope = step(s)
            s = s - (d - world.radius)[:, None] * slope
        d = np.asarray(jax.vmap(world.distance)(s))
        side = min(b - a for a, b in zip(world.low, world.high, strict=True))
        s = np.asarray(s)[np.abs(d - world.radius) < NEAR * side]
    return s[np.random.default_rng(0).choice(len(s), OUTLINE)]
