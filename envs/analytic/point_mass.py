"""Point mass: a robot on a plane, pushed about.

    p' = v,   v' = a u,   exactly integrated for a force that is held
    r = -(|p - c|^2 + 0.01 |u|^2), at the state after the step; c = (0.5, 0.5)

o = (p, v) [4] in m and m/s; a = 2 m/s^2; start: p uniform in the unit square, at rest; a
decision is 0.1 s; never terminates, and has no walls.

Source: thesis sections 5.3 and 6.1.1, where the plane is the unit square; a is ours.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic import integrate
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.types import EnvState, Spec

DT = 0.1  # [s] of a decision
PUSH = 2.0  # [m/s^2]
MIDDLE = (0.5, 0.5)  # [m]


@dataclass(frozen=True)
class PointMass:
    """Moves about."""

    @property
    def spec(self) -> Spec:
        """Sizes and rate."""
        return Spec(obs=4, act=2, dt=DT)

    def reset(self, key: Array) -> EnvState:
        """A first state, drawn with `key`."""
        p = jax.random.uniform(key, (2,), jnp.float32)
        return integrate.state(jnp.concatenate([p, jnp.zeros(2)]), jnp.float32(0.0))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [2] in [-1, 1]."""
        u = jnp.clip(action, -1.0, 1.0)
        x = self.dynamics(state.data, u)
        apart = x[:2] - jnp.array(MIDDLE)
        return integrate.state(x, -(jnp.sum(apart**2) + 0.01 * jnp.sum(u**2)))

    def dynamics(self, x: Array, u: Array) -> Array:
        """The observation [4] that follows x [4] under u [2]."""
        p, v = x[:2], x[2:]
        return jnp.concatenate([p + v * DT + 0.5 * PUSH * u * DT**2, v + PUSH * u * DT])

    def equilibrium(self) -> tuple[Array, Array]:
        """In the middle, without a push."""
        return jnp.array([*MIDDLE, 0.0, 0.0]), jnp.zeros(2)

    def to_local(self, x: Array) -> Array:
        """Local coordinates e [4] of x [4]."""
        return x - self.equilibrium()[0]

    def from_local(self, e: Array) -> Array:
        """The observation [4] of e [4]."""
        return self.equilibrium()[0] + e

    def scene(self) -> str:
        """MJCF text of the world as it is drawn."""
        return mjcf.text("point_mass.xml")

    def pose(self, state: EnvState) -> Array:
        """Positions qpos [2] of the drawn world."""
        return state.data[:2]
