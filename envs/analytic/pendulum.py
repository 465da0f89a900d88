"""Pendulum: swing up and balance with a motor too weak to lift it in one swing.

    w' = w + (3 g / (2 l) sin theta + 3 u / (m l^2)) dt,  clipped to [-8, 8]
    theta' = theta + w' dt
    r = -(theta^2 + 0.1 w^2 + 0.001 u^2), of the state before the step

theta = 0 is upright, wrapped to [-pi, pi) in r; g = 10, m = l = 1; a: torque u, as a fraction
of 2 N m; o = (cos theta, sin theta, w) [3]; start: theta ~ U(-pi, pi), w ~ U(-1, 1); a decision
is 0.05 s; never terminates.

Source: Gymnasium's Pendulum-v1.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.fields import part
from hybrid_rl.types import EnvState, Spec

DT = 0.05  # [s] of a decision
TORQUE = 2.0  # [N m]
MAX_SPEED = 8.0  # [rad/s]


@part
class Pendulum:
    """Pendulum swing-up."""

    spec = Spec(obs=3, act=1, dt=DT)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        bounds = jnp.array([jnp.pi, 1.0], jnp.float32)
        x = jax.random.uniform(key, (2,), jnp.float32, -bounds, bounds)
        return EnvState(x, self.from_local(x), jnp.float32(0.0))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [1] in [-1, 1]."""
        theta, w = state.data
        u = TORQUE * jnp.clip(action[0], -1.0, 1.0)
        x = _next(theta, w, u)
        return EnvState(x, self.from_local(x), _reward(theta, w, u))

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [1] at x [3], which led to `after` [3]."""
        return _reward(jnp.arctan2(x[1], x[0]), x[2], TORQUE * u[0])

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Height of the tip, -1 to 1, and angular velocity [rad/s] at obs [3]."""
        return {"height": obs[0], "speed": obs[2]}

    def dynamics(self, x: Array, u: Array) -> Array:
        """The next observation [3] after action u [1] at x [3]."""
        return self.from_local(_next(jnp.arctan2(x[1], x[0]), x[2], TORQUE * u[0]))

    def equilibrium(self) -> tuple[Array, Array]:
        """Upright and at rest."""
        return jnp.array([1.0, 0.0, 0.0]), jnp.zeros(1)

    def to_local(self, x: Array) -> Array:
        """Angle and angular velocity [2] of the observation x [3]."""
        return jnp.stack((jnp.arctan2(x[1], x[0]), x[2]))

    def from_local(self, e: Array) -> Array:
        """The observation [3] at local coordinates e [2]."""
        return jnp.stack((jnp.cos(e[0]), jnp.sin(e[0]), e[1]))

    scene = mjcf.scene("pendulum.xml")

    def pose(self, state: EnvState) -> Array:
        """Joint positions qpos [1] for rendering."""
        return state.data[:1]


def _next(theta: Array, w: Array, u: Array) -> Array:
    """Angle and angular velocity [2] after one decision with torque u [] [N m]."""
    w = jnp.clip(w + (15.0 * jnp.sin(theta) + 3.0 * u) * DT, -MAX_SPEED, MAX_SPEED)
    return jnp.stack((theta + w * DT, w))


def _reward(theta: Array, w: Array, u: Array) -> Array:
    """The reward [] of torque u [] [N m] at an angle and angular velocity []."""
    error = (theta + jnp.pi) % (2 * jnp.pi) - jnp.pi
    return -(error**2 + 0.1 * w**2 + 0.001 * u**2)
