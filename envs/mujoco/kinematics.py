"""Forward and inverse kinematics of a site of a robot arm, and inverse dynamics without contacts.

    pose       p(q) [3], r(q) [4]: product of the transforms along the chain, r a quaternion w x y z
    Jacobian   hinge: (a x (p - c), a),   slide: (a, 0);   a axis, c anchor, in the world frame
    damped least squares   qd = q0 + J' (J J' + l^2 I)^-1 (V - J q0),   V = (v, w) [6]
    torques    (M(q) + armature) q'' + C(q, q') q' + D q' - J' m g (1 - gravcomp), by recursive
               Newton-Euler in the world frame, which is faster than MJX's for one arm

Computed from qpos and the constants of the model, so that all implementations of the physics give
the same result. Quaternions are [4], w x y z, of unit length.

Source: Wampler 1986; Nakamura and Hanafusa 1986 (damped least squares); Luh, Walker and Paul 1980
(recursive Newton-Euler); MuJoCo's documentation, "Computation".
"""

from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from jax import Array
from jax.scipy.linalg import cho_factor, cho_solve

from hybrid_rl.envs.mujoco import mjcf

HINGE = mujoco.mjtJoint.mjJNT_HINGE


def quat_multiply(r: Array, s: Array) -> Array:
    """The rotation [4] by s, followed by r."""
    w = r[0] * s[0] - (r[1:] * s[1:]).sum()
    return jnp.concatenate((w[None], r[0] * s[1:] + s[0] * r[1:] + jnp.cross(r[1:], s[1:])))


def rotate(r: Array, v: Array) -> Array:
    """The vector v [3] rotated by r [4]."""
    t = 2 * jnp.cross(r[1:], v)
    return v + r[0] * t + jnp.cross(r[1:], t)


def inverse(r: Array) -> Array:
    """The inverse rotation [4] of r [4]."""
    return jnp.concatenate((r[:1], -r[1:]))


def from_axis_angle(axis: Array, angle: Array) -> Array:
    """The rotation [4] by angle [rad] about the unit vector axis [3]."""
    return jnp.concatenate((jnp.cos(angle / 2)[None], jnp.sin(angle / 2) * axis))


def rotation_vector(r: Array) -> Array:
    """2 sin(angle / 2) axis [3] of r [4]; for small angles the rotation vector [rad]."""
    return 2 * jnp.where(r[0] < 0, -1.0, 1.0) * r[1:]


class Links(NamedTuple):
    """A chain as L links: a constant transform each, then its joint, if it has one."""

    pos: np.ndarray  # [L, 3]
    quat: np.ndarray  # [L, 4]
    axis: np.ndarray  # [L, 3] of the joint, 0 without a joint
    anchor: np.ndarray  # [L, 3]
    hinge: np.ndarray  # [L] bool: hinge, not slide
    address: np.ndarray  # [L] of the joint in qpos, -1 without a joint
    reference: np.ndarray  # [L] qpos at which the joint transform is the identity


@dataclass(frozen=True)
class Chain:
    """The bodies from the world to `site` of the model `asset`; hinge and slide joints only."""

    asset: str
    site: str

    def pose(self, qpos: Array) -> tuple[Array, Array, Array]:
        """Position [3] and rotation [4] of the site and Jacobian [6, joints], at qpos [nq].

        The Jacobian's rows are linear, then angular velocity in the world frame; its columns are
        the joints along the chain.
        """
        own = links(self.asset, self.site)
        has_joint = own.address >= 0
        reference = own.reference.astype(np.float32)
        angles = jnp.where(has_joint, qpos[own.address] - reference, 0.0)

        def add_link(carry: tuple, link: tuple) -> tuple:
            (p, r), (pos, quat, axis, anchor, hinge, angle) = carry, link
            p, r = p + rotate(r, pos), quat_multiply(r, quat)
            a, c = rotate(r, axis), p + rotate(r, anchor)
            rotated = quat_multiply(r, from_axis_angle(axis, angle))
            p = jnp.where(hinge, c - rotate(rotated, anchor), p + a * angle)
            return (p, jnp.where(hinge, rotated, r)), (a, c)

        tables = [jnp.asarray(table, jnp.float32) for table in own[:4]]
        start = (jnp.zeros(3), jnp.eye(4, dtype=jnp.float32)[0])
        (p, r), (a, c) = jax.lax.scan(add_link, start, (*tables, own.hinge, angles))
        hinge = own.hinge[:, None]
        linear = jnp.where(hinge, jnp.cross(a, p[None] - c), a)
        angular = jnp.where(hinge, a, 0.0)
        return p, r, jnp.concatenate((linear, angular), 1)[has_joint].T

    def constant_pose(self, qpos: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
        """Position [3] and rotation [4] of the site, in NumPy; qpos: the first coordinates."""
        return _constant_pose(self.asset, self.site, qpos)


@cache
def _constant_pose(asset: str, site: str, qpos: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    model, quat = mjcf.load(asset), np.empty(4)
    data = mujoco.MjData(model)
    data.qpos[: len(qpos)] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mju_mat2Quat(quat, data.site(site).xmat)
    return data.site(site).xpos.astype(np.float32), quat.astype(np.float32)


@cache
def links(asset: str, site: str) -> Links:
    """The links from the world to a site."""
    model = mjcf.load(asset)
    end = model.site(site)
    bodies = [int(end.bodyid[0])]
    while parent := int(model.body_parentid[bodies[0]]):
        bodies.insert(0, parent)
    zero, identity = np.zeros(3), np.eye(4)[0]
    found = []
    for body in bodies:
        pos, quat = model.body_pos[body], model.body_quat[body]
        first, count = model.body_jntadr[body], model.body_jntnum[body]
        for j in range(first, first + count):
            address, hinge = model.jnt_qposadr[j], model.jnt_type[j] == HINGE
            joint = (model.jnt_axis[j], model.jnt_pos[j], hinge, address, model.qpos0[address])
            found.append((pos, quat, *joint))
            pos, quat = zero, identity
        if not count:
            found.append((pos, quat, zero, zero, False, -1, 0.0))
    found.append((end.pos, end.quat, zero, zero, False, -1, 0.0))
    return Links(*(np.array(column) for column in zip(*found, strict=True)))


def damped_inverse(jacobian: Array, velocity: Array, damping: float, desired: Array) -> Array:
    """Joint velocities [n] that give about `velocity` [6], as close as possible to `desired` [n].

    jacobian: [6, n]. `damping` bounds the result near singular configurations, where the site
    moves more slowly than `velocity`.
    """
    square = jacobian @ jacobian.T + damping**2 * jnp.eye(6)
    remaining = velocity - jacobian @ desired
    return desired + jacobian.T @ cho_solve(cho_factor(square), remaining)


def rotate_towards(rotation: Array, target: Array, gain: float) -> Array:
    """Angular velocity [3], world frame, from `rotation` [4] towards `target` [4]; gain [1/s]."""
    return gain * rotation_vector(quat_multiply(target, inverse(rotation)))


def joint_rates(
    pose: tuple[Array, Array, Array], linear: Array, rotation: Array, away: Array, gains: Any
) -> Array:
    """Joint velocities [n] that move a site by `linear` [3] [m/s] and turn it to `rotation` [4].

    pose: what `Chain.pose` gives. away: [n] [rad] from the joints to a posture, to which the null
    space leads. gains: what has `hold` and `posture` [1/s] and `damping`, as a world of an arm.
    """
    twist = jnp.concatenate((linear, rotate_towards(pose[1], rotation, gains.hold)))
    return damped_inverse(pose[2], twist, gains.damping, gains.posture * away)


def stay_within(velocity: Array, position: Array, low: tuple, high: tuple) -> Array:
    """`velocity`, set to 0 where it would leave the box [low, high]; all of one length."""
    below, above = position < jnp.array(high), position > jnp.array(low)
    return jnp.where(jnp.where(velocity > 0, below, above), velocity, 0.0)


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
