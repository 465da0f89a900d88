"""Humanoid: a robot with two legs and two arms runs forward.

    r = 5 [healthy] + 1.25 dx/dt - 0.1 |c|^2 - min(5e-7 |f|^2, 10);
    healthy: 1 < z < 2 m; terminates when not healthy

x: centre of mass [m]; z: height of the torso; a: seventeen torques, as fractions of their limits;
c = 0.4 a: controls; f: forces and torques of contacts [14, 6] (cfrc_ext). Start: qpos and qvel ~
U(-0.01, 0.01) around the upright pose; a decision is 5 steps of 0.003 s.

    short   o = (qpos without x and y, qvel) [45]
    full    o = (short, cinert, cvel, qfrc_actuator, f) [348], as Humanoid-v5 by default

A decision ends in the state of Humanoid-v5, whose solver is another one: 2e-5 in MuJoCo C, 1e-4 in
MJX, 2e-4 in Warp. Gymnasium takes x, f, cinert and cvel from the last stage of the integrator; ours
are those of the state after the step. So the reward differs by 0.002 on average, and by 0.2 on
impact. With the integrator euler rates differ by 0.5 rad/s a decision (median), at most 3.

Source: Tassa, Erez, Todorov 2012; parameters of Gymnasium's Humanoid-v5.
"""

from typing import Literal

import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.locomotion import Runner
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState
from hybrid_rl.fields import part
from hybrid_rl.types import Spec

ASSETS = {"rk4": "humanoid.xml", "euler": "humanoid_euler.xml"}  # by integrator
LIMIT = 0.4  # of a control
REWARD_READS = ("subtree_com", "cfrc_ext")
OBSERVATION_READS = {"short": (), "full": ("cinert", "cvel", "qfrc_actuator")}


@part
class Humanoid(Runner):
    """Humanoid; `physics` is native, mjx, warp or auto."""

    observation: Literal["short", "full"] = "short"
    integrator: Literal["rk4", "euler"] = "rk4"  # as Gymnasium; euler costs a quarter

    steps, dt, hidden, spread = 5, 0.015, 2, 0.01

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        return Spec(obs=45 if self.observation == "short" else 348, act=17, dt=self.dt)

    @property
    def _asset(self) -> str:
        return ASSETS[self.integrator]

    @property
    def _body(self) -> Physics:
        return self._physics(self._asset, REWARD_READS + OBSERVATION_READS[self.observation])

    def _control(self, action: Array) -> Array:
        return LIMIT * action

    def _x(self, data: PhysicsState) -> Array:
        return self._body.read(data, "subtree_com")[0, 0]

    def _paid(self, data: PhysicsState, control: Array, speed: Array) -> tuple[Array, Array]:
        ended = self.ended(data.qpos[2:])
        contact = jnp.minimum(5e-7 * (self._body.read(data, "cfrc_ext") ** 2).sum(), 10.0)
        return 5.0 * ~ended + 1.25 * speed - 0.1 * (control**2).sum() - contact, ended

    def _obs(self, data: PhysicsState) -> Array:
        seen = super()._obs(data)
        if self.observation == "short":
            return seen
        inertia, velocity, torque, force = (
            self._body.read(data, name) for name in (*OBSERVATION_READS["full"], "cfrc_ext")
        )
        more = inertia[1:].ravel(), velocity[1:].ravel(), torque[6:], force[1:].ravel()
        return jnp.concatenate((seen, *more))

    def ended(self, obs: Array) -> Array:
        """Whether [] an episode terminates at obs [o], of which it needs the height."""
        return ~((obs[0] > 1.0) & (obs[0] < 2.0))

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Height of the torso [m] and speed along x [m/s] at obs [o]."""
        return {"height": obs[0], "speed": obs[22]}
