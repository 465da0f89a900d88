"""Point mass: a double integrator on the plane.

    dp/dt = v,   dv/dt = a u - b v,   integrated exactly for a constant u
    r = -(|p - c|^2 + 0.01 |u|^2), of the state after the step; c = (0.5, 0.5)

o = (p, v) [4] in m and m/s; a = 2 m/s^2, b = 0; start: p uniform in the unit square, v = 0; a
decision is 0.1 s; never terminates; there are no walls.

Source: thesis sections 5.3 and 6.1.1; a and b are our choice.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic.state import Euclidean
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.fields import NotNegative, Positive, part
from hybrid_rl.types import EnvState, Spec

DT = 0.1  # [s] of a decision
ACCELERATION = 2.0  # [m/s^2] at u = 1
MIDDLE = (0.5, 0.5)  # [m]


@part
class PointMass(Euclidean):
    """Double integrator on the plane."""

    acceleration: Positive = ACCELERATION  # [m/s^2] a
    drag: NotNegative = 0.0  # [1/s] b

    spec = Spec(obs=4, act=2, dt=DT)

    def initial(self, key: Array) -> Array:
        """A random initial observation [4]."""
        return jnp.concatenate([jax.random.uniform(key, (2,), jnp.float32), jnp.zeros(2)])

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [2] at x [4], which led to `after` [4]."""
        error = after[:2] - jnp.array(MIDDLE)
        return -(jnp.sum(error**2) + 0.01 * jnp.sum(u**2))

    def dynamics(self, x: Array, u: Array) -> Array:
        """The next observation [4] after action u [2] at x [4]."""
        return move(x, self.acceleration * u, self.drag, DT)

    def equilibrium(self) -> tuple[Array, Array]:
        """At rest in the middle of the unit square."""
        return jnp.array([*MIDDLE, 0.0, 0.0]), jnp.zeros(2)

    scene = mjcf.scene("point_mass.xml")

    def pose(self, state: EnvState) -> Array:
        """Joint positions qpos [2] for rendering."""
        return state.data[:2]


def move(x: Array, a: Array, drag: float, dt: float) -> Array:
    """(p, v) [4] after `dt` [s] from x [4] under acceleration a [2] [m/s^2] and drag [1/s]."""
    p, v = x[:2], x[2:]
    if not drag:
        return jnp.concatenate([p + v * dt + 0.5 * a * dt**2, v + a * dt])
    share = -jnp.expm1(-drag * dt) / drag  # [s] integral of exp(-b t)
    return jnp.concatenate([p + share * v + (dt - share) / drag * a, v + share * (a - drag * v)])
