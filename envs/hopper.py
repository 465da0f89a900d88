"""Hopper: hop forward on one leg in the x-z plane.

    gymnasium   r = 1[healthy] + dx/dt - 0.001 |a|^2; terminates when not healthy;
                healthy: z > 0.7 m, |pitch| < 0.2 rad, all else in [-100, 100]
    pybullet    r as in `locomotion`; terminates when not alive;
                alive: z > 0.8 m and |pitch| < 1 rad

o = (qpos without x, qvel clipped to [-10, 10]) [11]; a: three torques, as fractions of 200 N m;
start: qpos and qvel ~ U(-0.005, 0.005) around the upright pose; a decision is 4 steps of 0.002 s.

Source: Erez, Tassa, Todorov 2011; parameters of Gymnasium's Hopper-v5; pybullet_envs.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.locomotion import pybullet_reward
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState, check
from hybrid_rl.envs.options import one_of
from hybrid_rl.types import EnvState, Spec

ASSET = "hopper.xml"
STEPS = 4  # physics steps per decision
DT = 0.008  # [s] of a decision


@dataclass(frozen=True)
class Hopper:
    """Hopper; `physics` is native, mjx, warp or auto."""

    physics: str = "auto"
    reward: str = "gymnasium"  # or pybullet

    def __post_init__(self) -> None:
        one_of("reward", self.reward, ("gymnasium", "pybullet"))
        check(self.physics)

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        return Spec(obs=11, act=3, dt=DT)

    @property
    def _body(self) -> Physics:
        return Physics(ASSET, self.physics)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        key_pos, key_vel = jax.random.split(key)
        upright = jnp.asarray(self._body.model.qpos0, jnp.float32)
        qpos = upright + jax.random.uniform(key_pos, (6,), jnp.float32, -0.005, 0.005)
        qvel = jax.random.uniform(key_vel, (6,), jnp.float32, -0.005, 0.005)
        zero = jnp.float32(0.0)
        return _state(self._body.reset(qpos, qvel), zero, jnp.zeros((), bool), zero)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [3] in [-1, 1]."""
        action = jnp.clip(action, -1.0, 1.0)
        data = self._body.step(state.data, action, STEPS)
        speed = (data.qpos[0] - state.data.qpos[0]) / DT
        if self.reward == "gymnasium":
            alive = _healthy(data)
            reward = alive + speed - 0.001 * (action**2).sum()
        else:
            alive = (data.qpos[1] > 0.8) & (jnp.abs(data.qpos[2]) < 1.0)
            limits = jnp.asarray(self._body.model.jnt_range[3:], jnp.float32)
            reward = pybullet_reward(alive, speed, action, data.qpos[3:], data.qvel[3:], limits)
        return _state(data, reward, ~alive, speed)

    def ended(self, obs: Array) -> Array:
        """Whether [] an episode terminates at obs [11]."""
        z, pitch = obs[0], jnp.abs(obs[1])
        if self.reward == "gymnasium":
            return ~((z > 0.7) & (pitch < 0.2) & (jnp.abs(obs[1:]) < 100.0).all())
        return ~((z > 0.8) & (pitch < 1.0))

    def scene(self) -> str:
        """MJCF text of the scene for rendering."""
        return mjcf.text(ASSET)

    def pose(self, state: EnvState) -> Array:
        """Joint positions qpos [6] for rendering."""
        return state.data.qpos


def _healthy(data: PhysicsState) -> Array:
    """Whether [] the hopper is upright and within all bounds."""
    rest = jnp.concatenate((data.qpos[2:], data.qvel))
    return (data.qpos[1] > 0.7) & (jnp.abs(data.qpos[2]) < 0.2) & (jnp.abs(rest) < 100.0).all()


def _state(data: PhysicsState, reward: Array, terminated: Array, speed: Array) -> EnvState:
    obs = jnp.concatenate((data.qpos[1:], jnp.clip(data.qvel, -10.0, 10.0)))
    return EnvState(data, obs, reward, terminated, jnp.zeros((), bool), {"speed": speed}, {})
