"""Inverse dynamics: the joint torques that give an acceleration.

    tau = M(q) q'' + C(q, q') q' + g(q) - (damping, springs, gravity compensation)

Recursive Newton-Euler by MJX in pure JAX, float32.

Source: MuJoCo's documentation, "Computation: inverse dynamics".
"""

import jax
from jax import Array
from mujoco import mjx

from hybrid_rl.envs.mujoco import mjx_warp


def torques(asset: str, qpos: Array, qvel: Array, qacc: Array) -> Array:
    """Generalised forces [nv] that give qacc [nv] at qpos [nq], qvel [nv]."""
    model, data = mjx_warp.template(asset, "jax")
    with jax.numpy_rank_promotion("allow"):
        data = mjx.inverse(model, data.replace(qpos=qpos, qvel=qvel, qacc=qacc))
    return data.qfrc_inverse
