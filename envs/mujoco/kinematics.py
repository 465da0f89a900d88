"""Where a site of an arm is, how its joints move it, and how they shall move.

    pose       p(q) [3], r(q) [4]: transforms multiplied along the chain, r a quaternion w x y z
    Jacobian   hinge: (a x (p - c), a),   slide: (a, 0);   a axis, c anchor, in the world
    damped least squares   qd = q0 + J' (J J' + l^2 I)^-1 (V - J q0),   V = (v, w) [6]

A formula of qpos and of the model's tables, hence the same in every implementation of the
physics.

Source: Wampler 1986; Nakamura and Hanafusa 1986 (damped least squares).
"""

from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from jax import Array
from jax.scipy.linalg import cho_factor, cho_solve

from hybrid_rl.envs.mujoco import mjcf

HINGE = mujoco.mjtJoint.mjJNT_HINGE


def times(r: Array, s: Array) -> Array:
    """The rotation [4] that does s first, then r."""
    w = r[0] * s[0] - (r[1:] * s[1:]).sum()
    return jnp.concatenate((w[None], r[0] * s[1:] + s[0] * r[1:] + jnp.cross(r[1:], s[1:])))


def turn(r: Array, v: Array) -> Array:
    """v [3] turned by r [4]."""
    across = 2 * jnp.cross(r[1:], v)
    return v + r[0] * across + jnp.cross(r[1:], across)


def inverse(r: Array) -> Array:
    """The rotation [4] that undoes r."""
    return jnp.concatenate((r[:1], -r[1:]))


def about(axis: Array, angle: Array) -> Array:
    """The rotation [4] by angle [rad] about axis [3], of length 1."""
    return jnp.concatenate((jnp.cos(angle / 2)[None], jnp.sin(angle / 2) * axis))


def vector(r: Array) -> Array:
    """2 sin(angle / 2) axis [3] of r: for small angles the rotation vector [rad]."""
    return 2 * jnp.where(r[0] < 0, -1.0, 1.0) * r[1:]


class Rows(NamedTuple):
    """A chain as steps of one kind: shift and turn by a constant, then by the joint, if any."""

    pos: np.ndarray  # [L, 3]
    quat: np.ndarray  # [L, 4]
    axis: np.ndarray  # [L, 3] of the joint, 0 where none
    anchor: np.ndarray  # [L, 3]
    hinge: np.ndarray  # [L] bool
    address: np.ndarray  # [L] in qpos, -1 where no joint
    rest: np.ndarray  # [L] qpos at which the joint does nothing


@dataclass(frozen=True)
class Chain:
    """The bodies from the world to `site` of the model `asset`: hinges and slides alone."""

    asset: str
    site: str

    def pose(self, qpos: Array) -> tuple[Array, Array, Array]:
        """Position [3] and rotation [4] of the site and Jacobian [6, joints], at qpos [nq].

        Rows are linear, then angular velocity, in the world; columns run along the chain.
        """
        rows = _rows(self.asset, self.site)
        driven = rows.address >= 0
        moved = jnp.where(driven, qpos[rows.address] - rows.rest.astype(np.float32), 0.0)

        def along(carry: tuple, row: tuple) -> tuple:
            (p, r), (pos, quat, axis, anchor, hinge, angle) = carry, row
            p, r = p + turn(r, pos), times(r, quat)
            a, c = turn(r, axis), p + turn(r, anchor)
            turned = times(r, about(axis, angle))
            p = jnp.where(hinge, c - turn(turned, anchor), p + a * angle)
            return (p, jnp.where(hinge, turned, r)), (a, c)

        tables = [jnp.asarray(table, jnp.float32) for table in rows[:4]]
        start = (jnp.zeros(3), jnp.eye(4, dtype=jnp.float32)[0])
        (p, r), (a, c) = jax.lax.scan(along, start, (*tables, rows.hinge, moved))
        hinge = rows.hinge[:, None]
        linear = jnp.where(hinge, jnp.cross(a, p[None] - c), a)
        angular = jnp.where(hinge, a, 0.0)
        return p, r, jnp.concatenate((linear, angular), 1)[driven].T

    def at(self, qpos: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
        """Position [3] and rotation [4], constants, where the first coordinates are `qpos`."""
        return _at(self.asset, self.site, qpos)


@cache
def _at(asset: str, site: str, qpos: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    model, quat = mjcf.load(asset), np.empty(4)
    data = mujoco.MjData(model)
    data.qpos[: len(qpos)] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mju_mat2Quat(quat, data.site(site).xmat)
    return data.site(site).xpos.astype(np.float32), quat.astype(np.float32)


@cache
def _rows(asset: str, site: str) -> Rows:
    model = mjcf.load(asset)
    end = model.site(site)
    bodies = [int(end.bodyid[0])]
    while parent := int(model.body_parentid[bodies[0]]):
        bodies.insert(0, parent)
    none, still = np.zeros(3), np.eye(4)[0]
    rows = []
    for body in bodies:
        pos, quat = model.body_pos[body], model.body_quat[body]
        first, count = model.body_jntadr[body], model.body_jntnum[body]
        for j in range(first, first + count):
            address, hinge = model.jnt_qposadr[j], model.jnt_type[j] == HINGE
            joint = (model.jnt_axis[j], model.jnt_pos[j], hinge, address, model.qpos0[address])
            rows.append((pos, quat, *joint))
            pos, quat = none, still
        if not count:
            rows.append((pos, quat, none, none, False, -1, 0.0))
    rows.append((end.pos, end.quat, none, none, False, -1, 0.0))
    return Rows(*(np.array(column) for column in zip(*rows, strict=True)))


def damped(jacobian: Array, velocity: Array, damping: float, wish: Array) -> Array:
    """Joint velocities [n] by which J [6, n] gives about `velocity` [6], nearest to `wish` [n].

    They are bounded everywhere; near singular poses `damping` counts, and they give less.
    """
    square = jacobian @ jacobian.T + damping**2 * jnp.eye(6)
    missing = velocity - jacobian @ wish
    return wish + jacobian.T @ cho_solve(cho_factor(square), missing)


def hold(now: Array, wanted: Array, gain: float) -> Array:
    """Angular velocity [3] in the world that turns `now` [4] towards `wanted` [4]; gain [1/s]."""
    return gain * vector(times(wanted, inverse(now)))


def within(velocity: Array, position: Array, low: Array, high: Array) -> Array:
    """`velocity` without what leaves the box [low, high]; all of one shape."""
    up, down = jnp.where(position < high, velocity, 0.0), jnp.where(position > low, velocity, 0.0)
    return jnp.where(velocity > 0, up, down)
