"""Swimmer: three links swim along x in a viscous fluid.

    r = dx/dt - 0.0001 |a|^2

o = (qpos without x and y, qvel) [8]; a: two torques, as fractions of 150 N m; start: qpos and qvel
~ U(-0.1, 0.1); a decision is 4 steps of 0.01 s; never terminates. x is that of the head's joint.

Source: Coulom 2002; parameters of Gymnasium's Swimmer-v5.
"""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.locomotion import Runner
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.fields import part


@part
class Swimmer(Runner):
    """Swimmer; `physics` is native, mjx, warp or auto."""

    steps, dt, hidden, _asset = 4, 0.04, 2, "swimmer.xml"

    def _paid(self, data: PhysicsState, control: Array, speed: Array) -> tuple[Array, Array]:
        return speed - 1e-4 * (control**2).sum(), jnp.zeros((), bool)

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Heading [rad], and speed [m/s] at obs [8]."""
        return {"heading": obs[0], "speed": obs[3]}
