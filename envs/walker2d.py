"""Walker: walk forward on two legs in the x-z plane.

    gymnasium   alive: 0.8 m < z < 2 m and |pitch| < 1 rad
    pybullet    alive: z > 0.8 m and |pitch| < 1 rad

o [17]; a: six torques, as fractions of 100 N m; rewards, start and decisions: `locomotion`.

Source: Erez, Tassa, Todorov 2011; parameters of Gymnasium's Walker2d-v5; pybullet_envs.
"""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.locomotion import PlanarLegs
from hybrid_rl.fields import part


@part
class Walker2d(PlanarLegs):
    """Walker; `physics` is native, mjx, warp or auto."""

    _asset = "walker2d.xml"

    def alive(self, qpos: Array, qvel: Array) -> Array:
        """Whether [] it is upright at qpos without x [8]."""
        z, pitch = qpos[0], jnp.abs(qpos[1])
        highest = 2.0 if self.reward == "gymnasium" else jnp.inf
        return (z > 0.8) & (z < highest) & (pitch < 1.0)
