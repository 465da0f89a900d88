"""Half-cheetah: run forward in the x-z plane.

    gymnasium   r = dx/dt - 0.1 |a|^2
    pybullet    r as in `locomotion`; alive: |pitch| < 1 rad and no shin or thigh
                touches the floor

o = (qpos without x, qvel) [17]; a: six torques, as fractions of their limits; start:
qpos ~ U(-0.1, 0.1), qvel ~ 0.1 N(0, 1); a decision is 5 steps of 0.01 s; never terminates.

Source: P. Wawrzynski 2009; parameters of Gymnasium's HalfCheetah-v5; pybullet_envs.
"""

from typing import Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.locomotion import pybullet_reward
from hybrid_rl.envs.mujoco.body import Body
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState
from hybrid_rl.fields import part
from hybrid_rl.types import EnvState, Spec

ASSETS = {"gymnasium": "halfcheetah.xml", "pybullet": "halfcheetah_contact.xml"}  # by reward
STEPS = 5  # physics steps per decision
DT = 0.05  # [s] of a decision
LEGS = ("back_thigh", "back_shin", "front_thigh", "front_shin")


@part
class HalfCheetah(Body):
    """Half-cheetah; `physics` is native, mjx, warp or auto."""

    reward: Literal["gymnasium", "pybullet"] = "gymnasium"

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        return Spec(obs=17, act=6, dt=DT)

    @property
    def _body(self) -> Physics:
        return self._physics(ASSETS[self.reward])

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        key_pos, key_vel = jax.random.split(key)
        qpos = jax.random.uniform(key_pos, (9,), jnp.float32, -0.1, 0.1)
        qvel = 0.1 * jax.random.normal(key_vel, (9,), jnp.float32)
        return _state(self._body.reset(qpos, qvel), jnp.float32(0.0), jnp.float32(0.0))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [6] in [-1, 1]."""
        action = jnp.clip(action, -1.0, 1.0)
        data = self._body.step(state.data, action, STEPS)
        speed = (data.qpos[0] - state.data.qpos[0]) / DT
        if self.reward == "gymnasium":
            reward = speed - 0.1 * (action**2).sum()
        else:
            reward = self._pybullet(data, action, speed)
        return _state(data, reward, speed)

    def _pybullet(self, data: PhysicsState, action: Array, speed: Array) -> Array:
        model = self._body.model
        upright = jnp.abs(data.qpos[2]) < 1.0
        alive = upright & ~_kneels(self._body, data)
        limits = jnp.asarray(model.jnt_range[3:], jnp.float32)
        return pybullet_reward(alive, speed, action, data.qpos[3:], data.qvel[3:], limits)

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Height of the torso above its start [m], pitch [rad] and speed [m/s] at obs [17]."""
        return {"height": obs[0], "pitch": obs[1], "speed": obs[8]}


def _kneels(body: Physics, data: PhysicsState) -> Array:
    """Whether [] the lowest point of any shin or thigh is below the floor."""
    touches = []
    for leg in LEGS:
        radius, half, _ = body.model.geom(leg).size
        height = body.sensor(data, f"{leg}_centre")[2]
        slope = jnp.abs(body.sensor(data, f"{leg}_axis")[2])
        touches.append(height - half * slope < radius)
    return jnp.stack(touches).any()


def _state(data: PhysicsState, reward: Array, speed: Array) -> EnvState:
    obs = jnp.concatenate((data.qpos[1:], data.qvel))
    return EnvState(data, obs, reward, metrics={"speed": speed})
