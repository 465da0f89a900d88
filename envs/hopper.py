"""Hopper: hop forward on one leg in the x-z plane.

    gymnasium   alive: z > 0.7 m, |pitch| < 0.2 rad, all else in [-100, 100]
    pybullet    alive: z > 0.8 m and |pitch| < 1 rad

o [11]; a: three torques, as fractions of 200 N m; rewards, start and decisions: `locomotion`.

Source: Erez, Tassa, Todorov 2011; parameters of Gymnasium's Hopper-v5; pybullet_envs.
"""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.locomotion import PlanarLegs
from hybrid_rl.fields import part


@part
class Hopper(PlanarLegs):
    """Hopper; `physics` is native, mjx, warp or auto."""

    _asset = "hopper.xml"

    def alive(self, qpos: Array, qvel: Array) -> Array:
        """Whether [] it is upright at qpos without x [5], and within all bounds with qvel [6]."""
        z, pitch = qpos[0], jnp.abs(qpos[1])
        if self.reward == "pybullet":
            return (z > 0.8) & (pitch < 1.0)
        rest = jnp.concatenate((qpos[1:], qvel))
        return (z > 0.7) & (pitch < 0.2) & (jnp.abs(rest) < 100.0).all()
