"""Cart and pole: swing the pole up and balance it.

    cos         r = cos theta                                    (the thesis, pybullet)
    dm_control  r = upright * centred * quiet * calm, each in [0, 1]:
                upright = (1 + cos theta) / 2
                centred = (1 + exp(-x^2 ln 10 / 2^2)) / 2
                quiet   = (4 + (1 - a^2)) / 5
                calm    = (1 + exp(-w^2 ln 10 / 5^2)) / 2

o = (x, v, cos theta, sin theta, w) [5], theta = 0 is upright; a: force on the cart, as a fraction
of 100 N; start: at rest, theta ~ pi + U(-0.1, 0.1); a decision is one step of 0.0165 s; never
terminates.

Source: pybullet_envs, InvertedPendulumSwingupBulletEnv; Tassa et al. 2018,
DeepMind Control Suite, cartpole swingup.
"""

from math import log
from typing import Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.mujoco.body import Body
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.fields import part
from hybrid_rl.types import EnvState, Spec


@part
class Cartpole(Body):
    """Cartpole swing-up; `physics` is native, mjx, warp or auto."""

    reward: Literal["cos", "dm_control"] = "cos"

    _asset = "cartpole.xml"
    spec = Spec(obs=5, act=1, dt=0.0165)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        theta = jnp.pi + jax.random.uniform(key, (), jnp.float32, -0.1, 0.1)
        qpos = jnp.stack((jnp.float32(0.0), theta))
        return _state(self._body.reset(qpos, jnp.zeros(2, jnp.float32)), jnp.float32(0.0))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [1] in [-1, 1]."""
        action = jnp.clip(action, -1.0, 1.0)
        data = self._body.step(state.data, action, 1)
        reward = jnp.cos(data.qpos[1]) if self.reward == "cos" else _dm_control(data, action)
        return _state(data, reward)

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Position [m] and speed [m/s] of the cart, and the pole's height, -1 to 1, at obs [5]."""
        return {"position": obs[0], "speed": obs[1], "height": obs[2]}


def _dm_control(data: PhysicsState, action: Array) -> Array:
    """Reward [] of the DeepMind Control Suite."""
    upright = (1 + jnp.cos(data.qpos[1])) / 2
    centred = (1 + jnp.exp(-log(10) * (data.qpos[0] / 2) ** 2)) / 2
    quiet = (4 + (1 - action[0] ** 2)) / 5
    calm = (1 + jnp.exp(-log(10) * (data.qvel[1] / 5) ** 2)) / 2
    return upright * centred * quiet * calm


def _state(data: PhysicsState, reward: Array) -> EnvState:
    x, theta = data.qpos
    v, w = data.qvel
    obs = jnp.stack((x, v, jnp.cos(theta), jnp.sin(theta), w))
    return EnvState(data, obs, reward)
