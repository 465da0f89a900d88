"""Robots that run in the x-z plane: what hopper and walker share.

    gymnasium   r = 1[alive] + dx/dt - 0.001 |a|^2
    pybullet    r as in `locomotion`

qpos: x, z, pitch, joints. o = (qpos without x, qvel); observed velocities are clipped to
[-velocity_limit, velocity_limit], by default 10 as in Gymnasium. a: torques, as fractions of full
torque; start: qpos and qvel ~ U(-0.005, 0.005) around the upright pose; a decision is 4 steps of
0.002 s. Terminates when not alive, a rule of each robot and reward.

Source: Erez, Tassa, Todorov 2011; parameters of Gymnasium; pybullet_envs.
"""

from abc import abstractmethod
from typing import ClassVar, Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.locomotion import Runner, pybullet_reward
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.fields import Positive, part


@part
class PlanarLegs(Runner):
    """A robot by its `asset` and `alive`; `physics` is native, mjx, warp or auto."""

    reward: Literal["gymnasium", "pybullet"] = "gymnasium"
    velocity_limit: Positive | None = 10.0  # of observed velocities [m/s, rad/s]
    asset: ClassVar[str]
    steps, dt, hidden, spread = 4, 0.008, 1, 0.005

    @abstractmethod
    def alive(self, qpos: Array, qvel: Array) -> Array:
        """Whether [] an episode goes on at qpos without x [nq - 1] and qvel [nv]."""

    @property
    def _asset(self) -> str:
        return self.asset

    def _start(self, key: Array, size: int) -> Array:
        return jax.random.uniform(key, (size,), jnp.float32, -self.spread, self.spread)

    def _obs(self, data: PhysicsState) -> Array:
        seen, limit = data.qvel, self.velocity_limit
        if limit is not None:
            seen = jnp.clip(seen, -limit, limit)
        return jnp.concatenate((data.qpos[1:], seen))

    def _paid(self, data: PhysicsState, control: Array, speed: Array) -> tuple[Array, Array]:
        alive = self.alive(data.qpos[1:], data.qvel)
        if self.reward == "gymnasium":
            return alive + speed - 0.001 * (control**2).sum(), ~alive
        limits = jnp.asarray(self._body.model.jnt_range[3:], jnp.float32)
        reward = pybullet_reward(alive, speed, control, data.qpos[3:], data.qvel[3:], limits)
        return reward, ~alive

    def ended(self, obs: Array) -> Array:
        """Whether [] an episode terminates at obs [o]."""
        joints = self._body.model.nq - 1
        return ~self.alive(obs[:joints], obs[joints:])

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Height of the torso [m], pitch [rad] and speed [m/s] at obs [o]."""
        return {"height": obs[0], "pitch": obs[1], "speed": obs[self._body.model.nq - 1]}
