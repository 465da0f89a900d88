"""Half-cheetah: run forward in the x-z plane.

    gymnasium   r = dx/dt - 0.1 |a|^2
    pybullet    r as in `locomotion`; alive: |pitch| < 1 rad and no shin or thigh
                touches the floor

o = (qpos without x, qvel) [17]; a: six torques, as fractions of their limits; start:
qpos ~ U(-0.1, 0.1), qvel ~ 0.1 N(0, 1); a decision is 5 steps of 0.01 s; never terminates.

Source: P. Wawrzynski 2009; parameters of Gymnasium's HalfCheetah-v5; pybullet_envs.
"""

from typing import Literal

import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.locomotion import Runner, pybullet_reward
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState
from hybrid_rl.fields import part

ASSETS = {"gymnasium": "halfcheetah.xml", "pybullet": "halfcheetah_contact.xml"}  # by reward
LEGS = ("back_thigh", "back_shin", "front_thigh", "front_shin")


@part
class HalfCheetah(Runner):
    """Half-cheetah; `physics` is native, mjx, warp or auto."""

    reward: Literal["gymnasium", "pybullet"] = "gymnasium"
    steps, dt, hidden, gaussian = 5, 0.05, 1, True

    @property
    def _asset(self) -> str:
        return ASSETS[self.reward]

    def _paid(self, data: PhysicsState, control: Array, speed: Array) -> tuple[Array, Array]:
        never = jnp.zeros((), bool)
        if self.reward == "gymnasium":
            return speed - 0.1 * (control**2).sum(), never
        upright = jnp.abs(data.qpos[2]) < 1.0
        alive = upright & ~_kneels(self._body, data)
        limits = jnp.asarray(self._body.model.jnt_range[3:], jnp.float32)
        reward = pybullet_reward(alive, speed, control, data.qpos[3:], data.qvel[3:], limits)
        return reward, never

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
