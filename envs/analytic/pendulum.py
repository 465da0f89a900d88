"""Pendulum: swing up and hold, with a motor too weak to do it in one go.

    w' = w + (3 g / (2 l) sin theta + 3 u / (m l^2)) dt,  clipped to +-8
    theta' = theta + w' dt
    r = -(theta^2 + 0.1 w^2 + 0.001 u^2), at the state before the step

theta in (-pi, pi] for r, 0 upright; g = 10, m = l = 1; a: torque u, as a fraction of
2 N m; o = (cos theta, sin theta, w) [3]; start: theta U(-pi, pi), w U(-1, 1); a decision
is 0.05 s; never terminates.

Source: Gymnasium's Pendulum-v1.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.types import EnvState, Spec

DT = 0.05  # [s] of a decision
TORQUE = 2.0  # [N m]
SPEED = 8.0  # [rad/s] greatest


@dataclass(frozen=True)
class Pendulum:
    """Swings up."""

    @property
    def spec(self) -> Spec:
        """Sizes and rate."""
        return Spec(obs=3, act=1, dt=DT)

    def reset(self, key: Array) -> EnvState:
        """A first state, drawn with `key`."""
        bounds = jnp.array([jnp.pi, 1.0], jnp.float32)
        x = jax.random.uniform(key, (2,), jnp.float32, -bounds, bounds)
        return _state(x, jnp.float32(0.0))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [1] in [-1, 1]."""
        theta, w = state.data
        u = TORQUE * jnp.clip(action[0], -1.0, 1.0)
        error = (theta + jnp.pi) % (2 * jnp.pi) - jnp.pi
        reward = -(error**2 + 0.1 * w**2 + 0.001 * u**2)
        return _state(_next(theta, w, u), reward)

    def dynamics(self, x: Array, u: Array) -> Array:
        """The observation [3] that follows x [3] under u [1]."""
        return _obs(_next(jnp.arctan2(x[1], x[0]), x[2], TORQUE * u[0]))

    def equilibrium(self) -> tuple[Array, Array]:
        """Upright."""
        return jnp.array([1.0, 0.0, 0.0]), jnp.zeros(1)

    def to_local(self, x: Array) -> Array:
        """Theta and w [2]."""
        return jnp.stack((jnp.arctan2(x[1], x[0]), x[2]))

    def from_local(self, e: Array) -> Array:
        """The observation [3] of e [2]."""
        return _obs(e)

    def scene(self) -> str:
        """MJCF text of the world as it is drawn."""
        return mjcf.text("pendulum.xml")

    def pose(self, state: EnvState) -> Array:
        """Positions qpos [1] of the drawn world."""
        return state.data[:1]


def _next(theta: Array, w: Array, u: Array) -> Array:
    """Theta and w [2] one decision after theta [] and w [] under the torque u [] [N m]."""
    w = jnp.clip(w + (15.0 * jnp.sin(theta) + 3.0 * u) * DT, -SPEED, SPEED)
    return jnp.stack((theta + w * DT, w))


def _obs(x: Array) -> Array:
    """x: [2] theta [rad], w [rad/s]."""
    return jnp.stack((jnp.cos(x[0]), jnp.sin(x[0]), x[1]))


def _state(x: Array, reward: Array) -> EnvState:
    """x: [2] theta [rad], w [rad/s]."""
    no = jnp.zeros((), bool)
    return EnvState(x, _obs(x), reward, no, no, {}, {})
