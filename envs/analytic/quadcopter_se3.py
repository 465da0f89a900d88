"""Quadcopter: a rigid body on SE(3) with four bidirectional rotors.

    p' = R v,   R' = R hat(w),   J w' = M - w x J w - J D_w w
    v' = F e_3 / m - w x v - g R' e_3 - D_v v,   F = kt sum u
    M = (kt l (u2 - u4), kt l (u3 - u1), km (u1 - u2 + u3 - u4))
    r = -(|p|^2 + 0.1 |v|^2 + 0.1 |w|^2), after the step

o = (p, R row by row, v, w) [18], v and w in the body frame, with `sensor_noise` N(0, std^2); a:
rotor controls u = 6 a; start: p ~ U(-away, away), R = R_z R_y R_x with Euler angles U(-turn, turn),
v and w ~ U(-twist, twist); a decision is one Runge-Kutta step of 0.005 s; terminates upside down.
`drag` (D_v, D_w) is in the author's code but not in the thesis' equations. From `fault_time` on,
`wind` accelerates the quadcopter along the world's x axis and rotor 1 loses the share `rotor_loss`
of its thrust; `dynamics` is without them.
Metrics: power_loss = |F - m g| [N], norm_of_u = |a| and twist = |v|^2 + |w|^2.

Source: thesis appendix D; parameters from the author's active-learning-koopman; twist from thesis
section 7.3; sensor noise, wind and rotor loss are our choice.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs import sensor_noise
from hybrid_rl.envs.analytic.state import fully_observed, rk4
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.fields import Fraction, NotNegative, part
from hybrid_rl.types import EnvState, Spec

DT, THRUST, G, MASS = 0.005, 6.0, 9.81, 0.6  # [s], u at a = 1, [m/s^2], [kg]
INERTIA = (0.04, 0.0375, 0.0675)  # [kg m^2]
ARM, KT, KM = 0.2, 0.6, 0.15  # [m], [N], [N m]
DRAG_V, DRAG_W = (0.4, 0.4, 2.0), (2.0, 2.0, 0.4)  # [1/s]


@part
class QuadcopterSE3:
    """Quadcopter that hovers at the origin, or flies there from up to `away` metres."""

    drag: bool = True
    twist: NotNegative = 0.5  # [m/s, rad/s] largest initial velocity in each direction
    away: NotNegative = 0.0  # [m] largest initial distance in each direction
    turn: NotNegative = 0.0  # [rad] largest initial Euler angle
    terminate: bool = True  # upside down
    sensor_noise: tuple[NotNegative, ...] = (0.0,)  # std of the observation: one for all, or [18]
    wind: float = 0.0  # [m/s^2] acceleration along the world's x axis
    rotor_loss: Fraction = 0.0  # share of rotor 1's thrust
    fault_time: NotNegative = 2.0  # [s] of an episode at which wind and loss begin

    spec = Spec(obs=18, act=4, dt=DT)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        twist = jax.random.uniform(key, (6,), jnp.float32, -self.twist, self.twist)
        p = self.away * jax.random.uniform(jax.random.fold_in(key, 1), (3,), minval=-1, maxval=1)
        x, hover = self.equilibrium()
        x = x.at[:3].set(p).at[12:].set(twist)
        if self.turn:
            angles = jax.random.uniform(jax.random.fold_in(key, 2), (3,), jnp.float32, -1, 1)
            about_x, about_y, about_z = map(_turned, jnp.eye(3), self.turn * angles)
            x = x.at[3:12].set((about_z @ about_y @ about_x).reshape(9))
        info = {"clock": jnp.zeros((), jnp.int32)} if self._faulty else {}
        metrics = _metrics(x, hover.astype(jnp.float32))
        state = fully_observed(x, jnp.float32(0.0)).replace(metrics=metrics, info=info)
        return sensor_noise.begin(state, self.sensor_noise, jax.random.fold_in(key, 3))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [4] in [-1, 1]."""
        u, info = jnp.clip(action, -1.0, 1.0), {}
        thrust, wind = u, None
        if self._faulty:
            begun = state.info["clock"] >= round(self.fault_time / DT)
            thrust = u.at[0].multiply(jnp.where(begun, 1 - self.rotor_loss, 1.0))
            wind, info = jnp.where(begun, self.wind, 0.0), {"clock": state.info["clock"] + 1}
        x = self.dynamics(state.data, thrust, wind)
        reward = self.reward_of(state.data, u, x)
        after = fully_observed(x, reward, self.terminate & (x[11] < 0))
        after = after.replace(metrics=_metrics(x, u), info=info)
        return sensor_noise.resume(after, self.sensor_noise, state)

    @property
    def _faulty(self) -> bool:
        """Whether anything happens at `fault_time`."""
        return self.wind != 0 or self.rotor_loss > 0

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [4] at x [18], which led to `after` [18]."""
        return -(jnp.sum(after[:3] ** 2) + 0.1 * jnp.sum(after[12:] ** 2))

    def dynamics(self, x: Array, u: Array, wind: Array | None = None) -> Array:
        """The next observation [18] after action u [4] at x [18], without noise and faults.

        But for `wind` [] [m/s^2], if it is given.
        """
        p, R, v, w = x[:3], x[3:12].reshape(3, 3), x[12:15], x[15:]
        p, R, v, w = rk4(lambda x: self._rate(x, THRUST * u, wind), (p, R, v, w), DT)
        R = R @ (1.5 * jnp.eye(3) - 0.5 * R.T @ R)  # re-orthogonalised to first order
        return jnp.concatenate([p, R.reshape(9), v, w])

    def _rate(self, x: tuple[Array, ...], u: Array, wind: Array | None) -> tuple[Array, ...]:
        """Time derivatives of (p, R, v, w) under rotor controls u [4] and `wind` [] [m/s^2]."""
        _, R, v, w = x
        turn = jnp.stack([u[1] - u[3], u[2] - u[0], (u[0] - u[1] + u[2] - u[3]) * KM / KT / ARM])
        inertia, up = jnp.array(INERTIA), jnp.array([0.0, 0.0, 1.0])
        vdot = KT / MASS * jnp.sum(u) * up - jnp.cross(w, v) - G * R[2]
        wdot = (KT * ARM * turn - jnp.cross(w, inertia * w)) / inertia
        if wind is not None:
            vdot = vdot + wind * R[0]
        if self.drag:
            vdot, wdot = vdot - jnp.array(DRAG_V) * v, wdot - jnp.array(DRAG_W) * w
        return R @ v, R @ _hat(w), vdot, wdot

    def equilibrium(self) -> tuple[Array, Array]:
        """Hovering at the origin."""
        upright = jnp.concatenate([jnp.zeros(3), jnp.eye(3).reshape(9), jnp.zeros(6)])
        return upright, jnp.full(4, MASS * G / (4 * KT * THRUST))

    def to_local(self, x: Array) -> Array:
        """(p, s, v, w) [12], s = sin(angle) axis of the rotation; for angles below 90 degrees."""
        R = x[3:12].reshape(3, 3)
        s = 0.5 * jnp.stack([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
        return jnp.concatenate([x[:3], s, x[12:]])

    def from_local(self, e: Array) -> Array:
        """The observation [18] at local coordinates e [12]."""
        s = _hat(e[3:6])
        cos = jnp.sqrt(jnp.maximum(1 - jnp.sum(e[3:6] ** 2), 1e-4))
        R = jnp.eye(3) + s + s @ s / (1 + cos)
        return jnp.concatenate([e[:3], R.reshape(9), e[6:]])

    scene = mjcf.scene("quadcopter_se3.xml")

    def pose(self, state: EnvState) -> Array:
        """Position and quaternion, qpos [7], for rendering."""
        R = state.data[3:12].reshape(3, 3)
        signs = jnp.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
        quat = 0.5 * jnp.sqrt(jnp.maximum(1 + signs @ jnp.diag(R), 0))
        turn = jnp.stack([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
        quat = quat.at[1:].set(jnp.copysign(quat[1:], turn))
        return jnp.concatenate([state.data[:3], quat / jnp.linalg.norm(quat)])


def _metrics(x: Array, u: Array) -> dict[str, Array]:
    """Metrics of a state x [18] and the action u [4] in [-1, 1] before it."""
    excess = KT * THRUST * jnp.sum(u) - MASS * G
    return {
        "power_loss": jnp.abs(excess),
        "norm_of_u": jnp.linalg.norm(u),
        "twist": jnp.sum(x[12:] ** 2),
    }


def _turned(axis: Array, angle: Array) -> Array:
    """The rotation [3, 3] about a unit vector [3] (Rodrigues' formula)."""
    k = _hat(axis)
    return jnp.eye(3) + jnp.sin(angle) * k + (1 - jnp.cos(angle)) * k @ k


def _hat(w: Array) -> Array:
    """The matrix [3, 3] of the cross product with w [3]."""
    o = jnp.zeros_like(w[0])
    return jnp.stack([o, -w[2], w[1], w[2], o, -w[0], -w[1], w[0], o]).reshape(3, 3)
