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

from hybrid_rl.envs.locomotion import pybullet_reward
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.body import Body
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState
from hybrid_rl.fields import Positive, part
from hybrid_rl.types import EnvState, Spec

STEPS = 4  # physics steps per decision
DT = 0.008  # [s] of a decision


@part
class PlanarLegs(Body):
    """A robot by its `asset` and `alive`; `physics` is native, mjx, warp or auto."""

    reward: Literal["gymnasium", "pybullet"] = "gymnasium"
    velocity_limit: Positive | None = 10.0  # of observed velocities [m/s, rad/s]
    asset: ClassVar[str]

    @abstractmethod
    def alive(self, qpos: Array, qvel: Array) -> Array:
        """Whether [] an episode goes on at qpos without x [nq - 1] and qvel [nv]."""

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        model = mjcf.load(self.asset)
        return Spec(obs=model.nq - 1 + model.nv, act=model.nu, dt=DT)

    @property
    def _body(self) -> Physics:
        return self._physics(self.asset)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        key_pos, key_vel = jax.random.split(key)
        upright = jnp.asarray(self._body.model.qpos0, jnp.float32)
        noise = [
            jax.random.uniform(k, upright.shape, jnp.float32, -0.005, 0.005)
            for k in (key_pos, key_vel)
        ]
        zero = jnp.float32(0.0)
        data = self._body.reset(upright + noise[0], noise[1])
        return self._state(data, zero, jnp.zeros((), bool), zero)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [m] in [-1, 1]."""
        action = jnp.clip(action, -1.0, 1.0)
        data = self._body.step(state.data, action, STEPS)
        speed = (data.qpos[0] - state.data.qpos[0]) / DT
        alive = self.alive(data.qpos[1:], data.qvel)
        if self.reward == "gymnasium":
            reward = alive + speed - 0.001 * (action**2).sum()
        else:
            limits = jnp.asarray(self._body.model.jnt_range[3:], jnp.float32)
            reward = pybullet_reward(alive, speed, action, data.qpos[3:], data.qvel[3:], limits)
        return self._state(data, reward, ~alive, speed)

    def _state(
        self, data: PhysicsState, reward: Array, terminated: Array, speed: Array
    ) -> EnvState:
        seen, limit = data.qvel, self.velocity_limit
        if limit is not None:
            seen = jnp.clip(seen, -limit, limit)
        obs = jnp.concatenate((data.qpos[1:], seen))
        return EnvState(data, obs, reward, terminated, metrics={"speed": speed})

    def ended(self, obs: Array) -> Array:
        """Whether [] an episode terminates at obs [o]."""
        joints = self._body.model.nq - 1
        return ~self.alive(obs[:joints], obs[joints:])

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Height of the torso [m], pitch [rad] and speed [m/s] at obs [o]."""
        return {"height": obs[0], "pitch": obs[1], "speed": obs[self._body.model.nq - 1]}
