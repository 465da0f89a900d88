"""Inverse dynamics of an arm without contacts: the joint torques that give an acceleration.

    tau = (M(q) + armature) q'' + C(q, q') q' + D q' - J' m g (1 - gravcomp)

by recursive Newton-Euler in the world frame. Computed from the constants of the model in pure JAX,
which is faster than MJX's for one arm.

Source: Luh, Walker and Paul 1980 (recursive Newton-Euler); MuJoCo's documentation, "Computation".
"""

from functools import cache
from typing import NamedTuple

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import from_axis_angle, quat_multiply, rotate


class Bodies(NamedTuple):
    """The L bodies of the arm, from the base on: a chain of hinges at their origins."""

    pos: np.ndarray  # [L, 3] in the body before
    quat: np.ndarray  # [L, 4]
    axis: np.ndarray  # [L, 3] of the hinge at the origin, 0 without one
    joint: np.ndarray  # [L] its index, -1 without one
    centre: np.ndarray  # [L, 3] of mass
    inertia: np.ndarray  # [L, 3, 3] about the centre of mass, in the body's axes
    mass: np.ndarray  # [L]
    weight: np.ndarray  # [L, 3] that is not compensated


def torques(asset: str, q: Array, rate: Array, acceleration: Array) -> Array:
    """Torques [n] for `acceleration` [n] at angles q [n] and rates [n] of the model `asset`."""
    model, arm = mjcf.load(asset), _bodies(asset)
    has_joint = arm.joint >= 0
    moved = [jnp.where(has_joint, x[arm.joint], 0.0) for x in (q, rate, acceleration)]

    def outward(before: tuple, body: tuple) -> tuple:
        (p, r, w, alpha, a), (pos, quat, axis, centre, angle, speed, gain) = before, body
        d = rotate(r, pos)
        a = a + jnp.cross(alpha, d) + jnp.cross(w, jnp.cross(w, d))
        p, r = p + d, quat_multiply(quat_multiply(r, quat), from_axis_angle(axis, angle))
        hinge, c = rotate(r, axis), rotate(r, centre)
        alpha = alpha + gain * hinge + speed * jnp.cross(w, hinge)
        w = w + speed * hinge
        at_centre = a + jnp.cross(alpha, c) + jnp.cross(w, jnp.cross(w, c))
        return (p, r, w, alpha, a), (p, r, w, alpha, p + c, at_centre, hinge)

    still = jnp.zeros(3)
    constants = [jnp.asarray(x, jnp.float32) for x in (arm.pos, arm.quat, arm.axis, arm.centre)]
    first = (still, jnp.eye(4)[0], still, still, still)
    p, r, w, alpha, c, a, hinge = jax.lax.scan(outward, first, (*constants, *moved))[1]

    def rate_of_spin(r: Array, w: Array, alpha: Array, inertia: Array) -> Array:
        turn = jax.vmap(rotate, (None, 0), 1)(r, jnp.eye(3))
        world = turn @ inertia @ turn.T
        return world @ alpha + jnp.cross(w, world @ w)

    force = jnp.asarray(arm.mass, jnp.float32)[:, None] * a - jnp.asarray(arm.weight, jnp.float32)
    spin = jax.vmap(rate_of_spin)(r, w, alpha, jnp.asarray(arm.inertia, jnp.float32))
    moment = spin + jnp.cross(c, force)
    force, moment = (jax.lax.cumsum(x, reverse=True) for x in (force, moment))  # of all beyond
    at_hinges = ((moment - jnp.cross(p, force)) * hinge).sum(1)[np.flatnonzero(has_joint)]
    armature, damping = (
        jnp.asarray(x.reshape(model.nv, -1)[:, 0], jnp.float32)
        for x in (model.dof_armature, model.dof_damping)
    )
    return at_hinges + armature * acceleration + damping * rate


@cache
def _bodies(asset: str) -> Bodies:
    model = mjcf.load(asset)
    joint = model.body_jntadr[1:]
    axis = np.where((joint >= 0)[:, None], model.jnt_axis[joint], 0.0)
    inertia = []
    for body in range(1, model.nbody):
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, model.body_iquat[body])
        turn = turn.reshape(3, 3)
        inertia.append(turn @ np.diag(model.body_inertia[body]) @ turn.T)
    mass, free = model.body_mass[1:], 1 - model.body_gravcomp[1:]
    weight = (mass * free)[:, None] * model.opt.gravity
    frames = model.body_pos[1:], model.body_quat[1:], axis, joint, model.body_ipos[1:]
    return Bodies(*frames, np.array(inertia), mass, weight)
