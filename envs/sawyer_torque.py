"""Sawyer under torque control: the tip of its rod follows a path.

    r = -100 |p - p_ref|^2

p, p_ref [m]: the tip and its reference, after the step; a: torques as fractions of 80, 80, 40, 40,
9, 9, 9 N m. o = (q, q', q_ref now, q'_ref now, q_ref next, q'_ref next) [42]; next: one decision
later. A decision is 0.01 s, 5 physics steps. The arm compensates its gravity. For `learn`
decisions the reference is the neutral pose, near which the arm starts at rest; then a second leads
to the path (`sawyer_reference`). Never terminates.

`damping`: none, or the maker's in its simulator, 10, 5, 5, 1, 2, 1, 1 N m s/rad. `payload`: mass
added to the rod, which the gravity compensation leaves out; with it the arm sinks. Metrics:
tip_error = |p - p_ref| [m], joint_rate = max |q'| [rad/s].

Source: thesis section 7.5.2 and appendix D (rate, path, state); limits of torque and damping:
Rethink Robotics' sawyer_robot. The reward, the start and the payload are our choice.
"""

from typing import Literal

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from jax import Array

from hybrid_rl.envs import sawyer_reference, sensor_noise
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import Chain
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState, Simulator
from hybrid_rl.envs.sawyer_reference import ASSET, NEUTRAL, SITE
from hybrid_rl.fields import Count, Natural, NotNegative, part
from hybrid_rl.types import EnvState, Spec

SCENE = "sawyer_torque_scene.xml"
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
        spec = mujoco.MjSpec.from_file(str(mjcf.path(SCENE)))
        marks = sawyer_reference.path(sawyer_reference.PERIOD / 60 * np.arange(60))
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
        rows = jnp.asarray(sawyer_reference.table(self.rounds, DT), jnp.float32)
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
