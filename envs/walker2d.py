"""Walker: walk forward on two legs in the x-z plane.

    gymnasium   r = 1[healthy] + dx/dt - 0.001 |a|^2; terminates when not healthy;
                healthy: 0.8 m < z < 2 m, |pitch| < 1 rad
    pybullet    r as in `locomotion`; terminates when not alive;
                alive: z > 0.8 m and |pitch| < 1 rad

o = (qpos without x, qvel clipped to [-10, 10]) [17]; a: six torques, as fractions of 100 N m;
start: qpos and qvel ~ U(-0.005, 0.005) around the upright pose; a decision is 4 steps of 0.002 s.

Source: Erez, Tassa, Todorov 2011; parameters of Gymnasium's Walker2d-v5; pybullet_envs.
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

ASSET = "walker2d.xml"
STEPS = 4  # physics steps per decision
DT = 0.008  # [s] of a decision


@dataclass(frozen=True)
class Walker2d:
    """Walker; `physics` is native, mjx, warp or auto."""

    physics: str = "auto"
    reward: str = "gymnasium"  # or pybullet

    def __post_init__(self) -> None:
        one_of("reward", self.reward, ("gymnasium", "pybullet"))
        check(self.physics)

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        return Spec(obs=17, act=6, dt=DT)

    @property
    def _body(self) -> Physics:
        return Physics(ASSET, self.physics)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        key_pos, key_vel = jax.random.split(key)
        upright = jnp.asarray(self._body.model.qpos0, jnp.float32)
        qpos = upright + jax.random.uniform(key_pos, (9,), jnp.float32, -0.005, 0.005)
        qvel = jax.random.uniform(key_vel, (9,), jnp.float32, -0.005, 0.005)
        zero = jnp.float32(0.0)
        return _state(self._body.reset(qpos, qvel), zero, jnp.zeros((), bool), zero)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [6] in [-1, 1]."""
        action = jnp.clip(action, -1.0, 1.0)
        data = self._body.step(state.data, action, STEPS)
        speed = (data.qpos[0] - state.data.qpos[0]) / DT
        alive = ~self.ended(data.qpos[1:])
        if self.reward == "gymnasium":
            reward = alive + speed - 0.001 * (action**2).sum()
        else:
            limits = jnp.asarray(self._body.model.jnt_range[3:], jnp.float32)
            reward = pybullet_reward(alive, speed, action, data.qpos[3:], data.qvel[3:], limits)
        return _state(data, reward, ~alive, speed)

    def ended(self, obs: Array) -> Array:
        """Whether [] an episode terminates at obs [17], of which it needs height and pitch."""
        highest = 2.0 if self.reward == "gymnasium" else jnp.inf
        return ~((obs[0] > 0.8) & (obs[0] < highest) & (jnp.abs(obs[1]) < 1.0))

    def scene(self) -> str:
        """MJCF text of the scene for rendering."""
        return mjcf.text(ASSET)

    def pose(self, state: EnvState) -> Array:
        """Joint positions qpos [9] for rendering."""
        return state.data.qpos


def _state(data: PhysicsState, reward: Array, terminated: Array, speed: Array) -> EnvState:
    obs = jnp.concatenate((data.qpos[1:], jnp.clip(data.qvel, -10.0, 10.0)))
    return EnvState(data, obs, reward, terminated, jnp.zeros((), bool), {"speed": speed}, {})
