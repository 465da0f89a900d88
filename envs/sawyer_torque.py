"""Sawyer under torque control: the tip of its rod follows a path.

    r = -100 |p - p_ref|^2

p, p_ref [m]: the tip and its reference, after the step; a: torques as fractions of 80, 80, 40, 40,
9, 9, 9 N m. o = (q, q', q_ref now, q'_ref now, q_ref next, q'_ref next) [42]; next: one decision
later. A decision is 0.01 s, 5 physics steps. The arm compensates its gravity. For `learn`
decisions the reference is the neutral pose, near which the arm starts at rest; then a second leads
to the path. Never terminates.

`damping`: none, or the maker's in its simulator, 10, 5, 5, 1, 2, 1, 1 N m s/rad. `payload`: mass
added to the rod, which the gravity compensation leaves out; with it the arm sinks. Metrics:
tip_error = |p - p_ref| [m], joint_rate = max |q'| [rad/s].

The path and the angles with which the tip follows it:

    p(t) = (0.8, 0.1 cos 2t, 0.1 sin 4t + 0.4) [m], of period pi s
    q(t) = argmin |q - n|^2 subject to p(q) = p(t),   n: neutral pose
    q <- n + J^+ (p(t) - p(q) + J (q - n)),   J = dp/dq [3, 7]

The iteration is least squares with the joints drawn to the neutral pose. q(t) is a Fourier series
through its solutions, which gives its rates and accelerations. A quintic polynomial of 1 s leads
from rest at the neutral pose to q(0) with its rates and accelerations.

Source: thesis section 7.5.2 and appendix D (rate, path, state); limits of torque and damping:
Rethink Robotics' sawyer_robot. Neutral pose: its sawyer_robot. The
reward, the start, the polynomial and the payload are our choice.
"""

from functools import cache
from typing import Literal

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from jax import Array
from scipy.interpolate import BPoly

from hybrid_rl.envs import sensor_noise
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import Chain
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState, Simulator
from hybrid_rl.fields import Count, Natural, NotNegative, part
from hybrid_rl.types import EnvState, Spec

ASSET, SITE = "sawyer_torque.xml", "tip"
NEUTRAL = (0.0, -1.18, 0.0, 2.18, 0.0, 0.57, 3.3161)  # [rad]
PERIOD = np.pi  # [s]
BLEND = 1.0  # [s] from the neutral pose to the path
SOLUTIONS = 128  # in a period; coefficients of the series are below 1e-12 rad from the 20th on
STEPS = 5  # physics steps per decision
DT = 0.01  # [s] of a decision
LIMITS = (80.0, 80.0, 40.0, 40.0, 9.0, 9.0, 9.0)  # [N m] at a = 1
DAMPING = {  # [N m s/rad]
    "none": (0.0,) * 7,
    "maker": (10.0, 5.0, 5.0, 1.0, 2.0, 1.0, 1.0),
}
ROD = 0.05  # [kg]
TIP = Chain(ASSET, SITE)


@part
class SawyerTorque:
    """Sawyer with torques as actions; `physics` is native, mjx, warp or auto."""

    physics: Simulator = "auto"
    damping: Literal["none", "maker"] = "none"  # of the joints
    payload: NotNegative = 0.0  # [kg] added to the rod
    learn: Natural = 2000  # decisions before the reference leaves the neutral pose
    rounds: Count = 2  # of the path
    start_spread: NotNegative = 0.05  # [rad] largest distance of each joint from the neutral pose
    sensor_noise: NotNegative = 0.0  # [rad/s] standard deviation, on q'

    spec = Spec(obs=42, act=7, dt=DT)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        spread, noise = jax.random.split(key)
        away = jax.random.uniform(spread, (7,), jnp.float32, -1.0, 1.0)
        qpos = jnp.asarray(NEUTRAL, jnp.float32) + self.start_spread * away
        data = self._body.reset(qpos, jnp.zeros(7, jnp.float32))
        state = self._state(data, jnp.zeros((), jnp.int32))
        return sensor_noise.begin(state.replace(reward=jnp.float32(0.0)), self._std, noise)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [7] in [-1, 1]."""
        data = self._body.step(state.data, jnp.clip(action, -1.0, 1.0), STEPS)
        after = self._state(data, state.info["count"] + 1)
        return sensor_noise.resume(after, self._std, state)

    def equilibrium(self) -> tuple[Array, Array]:
        """At rest in the neutral pose, which is the reference; without payload."""
        rest = jnp.concatenate([jnp.array(NEUTRAL), jnp.zeros(7)])
        return jnp.tile(rest, 3), jnp.zeros(7)

    def reference(self, obs: Array) -> tuple[Array, Array]:
        """The observations [42] with q and q' of the reference, now and one decision later."""
        _, now, later = jnp.split(obs, 3)
        return jnp.concatenate([now, now, later]), jnp.concatenate([later, now, later])

    def scene(self) -> str:
        """MJCF text of the scene for rendering, with points along the path."""
        spec = mjcf.spec("sawyer_torque_scene.xml")
        marks = path(PERIOD / 60 * np.arange(60))
        for mark in marks:
            spec.worldbody.add_site(pos=mark, size=[0.004, 0, 0], rgba=[0.95, 0.6, 0.15, 1])
        spec.compile()
        return spec.to_xml()

    def pose(self, state: EnvState) -> Array:
        """Joint angles [7], then position [3] of the reference, for rendering."""
        return jnp.concatenate((state.data.qpos, self._row(state.info["count"])[14:]))

    @property
    def _body(self) -> Physics:
        return Physics(asset(self.damping, self.payload), self.physics)

    @property
    def _std(self) -> tuple[float, ...]:
        return (0.0,) * 7 + (self.sensor_noise,) * 7 + (0.0,) * 28

    def _row(self, count: Array) -> Array:
        """(q_ref, q'_ref, p_ref) [17] after `count` [] decisions."""
        rows = jnp.asarray(table(self.rounds, DT), jnp.float32)
        return rows[jnp.clip(count - self.learn, 0, len(rows) - 1)]

    def _state(self, data: PhysicsState, count: Array) -> EnvState:
        now, later = self._row(count), self._row(count + 1)
        error = jnp.linalg.norm(TIP.pose(data.qpos)[0] - now[14:])
        obs = jnp.concatenate((data.qpos, data.qvel, now[:14], later[:14]))
        metrics = {"tip_error": error, "joint_rate": jnp.abs(data.qvel).max()}
        return EnvState(data, obs, -100 * error**2, metrics=metrics, info={"count": count})


def asset(damping: str, payload: float = 0.0) -> str:
    """The model with this damping of its joints and payload [kg]."""
    values = {f"joint.j{i}.damping": d for i, d in enumerate(DAMPING[damping]) if d}
    if payload:
        mass = ROD + payload
        values |= {"geom.rod.mass": mass, "body.rod.gravcomp": ROD / mass}
    return mjcf.changed(ASSET, values)


def path(t: np.ndarray) -> np.ndarray:
    """p [N, 3] [m] at times t [N] [s]."""
    return np.stack([np.full_like(t, 0.8), 0.1 * np.cos(2 * t), 0.1 * np.sin(4 * t) + 0.4], 1)


def tip(data: mujoco.MjData, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Position [3] of the tip and its Jacobian [3, 7] at q [7], in float64."""
    model, jacobian = mjcf.load(ASSET), np.zeros((3, 7))
    data.qpos[:] = q
    mujoco.mj_fwdPosition(model, data)
    site = model.site(SITE).id
    mujoco.mj_jacSite(model, data, jacobian, None, site)
    return data.site_xpos[site].copy(), jacobian


@cache
def _coefficients() -> np.ndarray:
    """Fourier coefficients [SOLUTIONS / 2 + 1, 7] of q(t)."""
    data, neutral = mujoco.MjData(mjcf.load(ASSET)), np.array(NEUTRAL)
    q, solutions = neutral, []
    for point in path(np.arange(SOLUTIONS) * PERIOD / SOLUTIONS):
        change = np.inf
        while change > 1e-12:
            p, jacobian = tip(data, q)
            after = neutral + np.linalg.pinv(jacobian) @ (point - p + jacobian @ (q - neutral))
            change, q = np.abs(after - q).max(), after
        solutions.append(q)
    return np.fft.rfft(solutions, axis=0, norm="forward")


def joints(t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """q, q', q'' [N, 7] of the path at times t [N] [s]."""
    c = _coefficients()
    w = 2 * np.pi / PERIOD * np.arange(len(c))
    twice = np.where(w > 0, 2.0, 1.0)  # negative frequencies
    waves = twice * np.exp(1j * np.outer(t, w))
    q, rate, acceleration = ((waves * (1j * w) ** k @ c).real for k in range(3))
    return q, rate, acceleration


@cache
def table(rounds: int, dt: float) -> np.ndarray:
    """(q, q', tip) [N, 17], one row every `dt` [s]: the blend, `rounds` of the path, then rest.

    The first row is the neutral pose at rest. The last one repeats the end of the path at rest.
    """
    blend = round(BLEND / dt)
    t = dt * np.arange(round(rounds * PERIOD / dt) + 1)
    q, rate, _ = joints(t)
    still = np.zeros(7)
    end = [part[0] for part in joints(t[:1])]
    quintic = BPoly.from_derivatives([0, BLEND], [[np.array(NEUTRAL), still, still], end])
    before = dt * np.arange(blend)
    q = np.concatenate([quintic(before), q, q[-1:]])
    rate = np.concatenate([quintic.derivative()(before), rate, still[None]])
    data = mujoco.MjData(mjcf.load(ASSET))
    return np.concatenate([q, rate, [tip(data, each)[0] for each in q]], 1)
