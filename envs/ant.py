"""Ant: a four-legged robot runs forward.

    pybullet    r as in `locomotion`; alive: z > 0.26 m; terminates when not alive
    gymnasium   r = 1[healthy] + dx/dt - 0.5 |a|^2; terminates when not healthy;
                healthy: 0.2 <= z <= 1 m and all finite

o = (qpos without x and y, qvel) [27]; a: eight torques, as fractions of 150 N m; start:
qpos ~ U(-0.1, 0.1) around the upright pose, qvel ~ 0.1 N(0, 1); a decision is 5 steps of 0.01 s.

    points      spheres at the ends of the capsules touch the floor, one where two capsules meet:
                not Gymnasium's contacts, but the same ones in MuJoCo C, MJX and Warp
    capsules    Gymnasium's contacts. In MuJoCo C a decision ends in the state of Ant-v5 (5e-6).
                Not in MJX and Warp, which turn the friction pyramid of a capsule that is less than
                30 degrees from vertical: rates differ by up to 2 rad/s.

The observation is that of Ant-v4; Ant-v5 adds 78 contact forces. The reward `gymnasium` is that of
Ant-v5 without its contact cost 0.0005 |clip(cfrc_ext, -1, 1)|^2, on average 0.001 a decision.
Gymnasium measures x in the last stage of the integrator, ours at the end of the step, so that
dx/dt differs by 0.01 m/s (rms).

Source: Schulman et al. 2015; parameters of Gymnasium's Ant-v5; reward of pybullet_envs, which the
thesis uses (its body weighs 182 kg there because the importer ignores the densities).
"""

from typing import Literal

import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.locomotion import Runner, pybullet_reward
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.fields import part

ASSETS = {  # by contacts and integrator
    ("points", "rk4"): "ant.xml",
    ("points", "euler"): "ant_euler.xml",
    ("capsules", "rk4"): "ant_capsules.xml",
    ("capsules", "euler"): "ant_capsules_euler.xml",
}


@part
class Ant(Runner):
    """Ant; `physics` is native, mjx, warp or auto."""

    reward: Literal["pybullet", "gymnasium"] = "pybullet"
    integrator: Literal["rk4", "euler"] = "rk4"  # as Gymnasium; euler, as Brax, costs a quarter
    contacts: Literal["points", "capsules"] = "points"

    steps, dt, hidden, gaussian = 5, 0.05, 2, True

    @property
    def _asset(self) -> str:
        return ASSETS[self.contacts, self.integrator]

    def _paid(self, data: PhysicsState, control: Array, speed: Array) -> tuple[Array, Array]:
        ended, model = self.ended(data.qpos[2:]), self._body.model
        if self.reward == "gymnasium":
            return ~ended + speed - 0.5 * (control**2).sum(), ended
        joints = model.actuator_trnid[:, 0]  # motors and joints are in different orders
        angle, velocity = data.qpos[7:][joints - 1], data.qvel[6:][joints - 1]
        limits = jnp.asarray(model.jnt_range[joints], jnp.float32)
        return pybullet_reward(~ended, speed, control, angle, velocity, limits), ended

    def ended(self, obs: Array) -> Array:
        """Whether [] an episode terminates at obs [27], of which it needs the height."""
        if self.reward == "gymnasium":
            return ~((obs[0] >= 0.2) & (obs[0] <= 1.0))
        return ~(obs[0] > 0.26)

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Height [m], velocity [m/s, m/s], turning rate [rad/s] of the torso at obs [27].

        `speed` is the velocity along x.
        """
        return {"height": obs[0], "speed": obs[13], "velocity": obs[13:15], "turning": obs[18]}
