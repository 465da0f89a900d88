"""SPRK: a hamster ball among solid objects in MuJoCo, which feels that it touches one.

    m dv/dt = m (a w - b v) + contact,   lag dw/dt = u - w,   dp/dt = v
    r = y, the measured contact, 0 or 1

o = (p, v) [4] in m and m/s. Objects, theta, start, sensor errors and metrics are those of
`contact_plane`; the contacts are MuJoCo's. The ball is simulated in the frame of the objects, where
they stand still:

    s~ = R(a)' (s - t) + c,   v~ = R(a)' v,   u~ = R(a)' u,   theta = (t, a)

A decision is 0.1 s, 30 physics steps. y is 1 after a decision in which

    touch           the force between ball and objects is above 0, at any other step
    accelerometer   |dv/dt - (a u - b v)| > threshold, of means over 1/30 s: a weak contact is
                    missed, and an action that changes faster than the motor follows is felt as one

Source: thesis sections 5.3 and 5.4 (a SPRK ball; collisions from the inertial sensor, false ones in
quick movements). Radius and mass: those of Sphero's SPRK+, not verified; a, b, the motor's lag,
the threshold and the contact's stiffness are our choice.
"""

from dataclasses import KW_ONLY
from functools import cached_property
from typing import Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.poses import from_map, rotated, to_map
from hybrid_rl.envs.analytic.contact_plane import ContactPlane, metrics_of, solid
from hybrid_rl.envs.analytic.point_mass import DT, move
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState, Simulator
from hybrid_rl.fields import NotNegative, Positive, part
from hybrid_rl.types import EnvState

TIMESTEP = 1 / 300  # [s]
READINGS, STEPS = 15, 2  # of the touch sensor in a decision; physics steps of a reading
MEANS = 3  # of the accelerometer in a decision: 30 Hz
HALF = 0.1  # [m] half height of the objects


@part
class Sprk(ContactPlane):
    """A ball among objects; `physics` is native, mjx, warp or auto."""

    physics: Simulator = "auto"
    _: KW_ONLY
    radius: Positive = 0.0365  # [m] of the ball
    mass: Positive = 0.18  # [kg] m
    lag: NotNegative = 0.01  # [s] of the motor; 0: none
    sensor: Literal["touch", "accelerometer"] = "touch"
    threshold: Positive = 0.5  # [m/s^2] of the accelerometer

    @cached_property
    def asset(self) -> str:
        """MJCF text of the ball and the objects in their reference arrangement."""
        words = {
            "TIMESTEP": TIMESTEP,
            "DYNAMICS": "filterexact" if self.lag else "none",
            "LAG": self.lag or 1.0,
            "FORCE": self.mass * self.acceleration,
            "DAMPING": self.mass * self.drag,
            "RADIUS": self.radius,
            "MASS": self.mass,
        }
        text = mjcf.text("sprk.xml")
        for word, value in words.items():
            text = text.replace(word, str(value))
        geoms, pairs = solid(self.objects, "ball", HALF)
        text = text.replace("</body>", f"{geoms}</body>", 1)
        return text[text.index("<mujoco") :].replace("</mujoco>", f"{pairs}</mujoco>")

    @property
    def _body(self) -> Physics:
        return Physics(self.asset, self.physics)

    def reset(self, key: Array) -> EnvState:
        """A random position and pose, those of `contact_plane` for the same key."""
        x, u, pose, noise = self._start(key)
        p = to_map(pose, x[:2], self.middle)
        data = self._body.reset(p, jnp.zeros(2))
        info = {"pose": pose, "action": u, "noise": noise}
        return self._seen(data, jnp.zeros(()), jnp.zeros(()), info)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [2] in [-1, 1]."""
        u, body, info = jnp.clip(action, -1.0, 1.0), self._body, state.info
        local = rotated(u, -info["pose"][2])

        def reading(data: PhysicsState, _: None) -> tuple[PhysicsState, tuple[Array, Array]]:
            data = body.step(data, local, STEPS)
            return data, (body.sensor(data, "touch")[0], data.qvel[:2])

        data, (force, v) = jax.lax.scan(reading, state.data, None, length=READINGS)
        v = jnp.concatenate([state.data.qvel[None, :2], v])[:: READINGS // MEANS]
        jolts = jax.vmap(self._jolt, (0, 0, None))(v[:-1], v[1:], local)
        touch = (force > 0).any().astype(jnp.float32)
        jolt = (jolts > self.threshold).any().astype(jnp.float32)
        felt = touch if self.sensor == "touch" else jolt
        measured, noise = self.measured(felt, u - info["action"], data.qpos, info["noise"])
        info = {**info, "action": u, "noise": noise}
        return self._seen(data, touch, measured, info)

    def _jolt(self, v: Array, after: Array, u: Array) -> Array:
        """|mean acceleration - commanded| [m/s^2] from v [2] to `after` [2] at u [2]."""
        time = DT / MEANS
        free = move(jnp.concatenate([jnp.zeros(2), v]), self.acceleration * u, self.drag, time)[2:]
        return jnp.linalg.norm(after - free) / time

    def _seen(
        self, data: PhysicsState, touch: Array, measured: Array, info: dict[str, Array]
    ) -> EnvState:
        pose = info["pose"]
        p = from_map(pose, data.qpos[:2], self.middle)
        obs = jnp.concatenate([p, rotated(data.qvel[:2], pose[2])])
        return EnvState(data, obs, measured, metrics=metrics_of(touch, pose), info=info)

    def pose(self, state: EnvState) -> Array:
        """theta and the position of the ball, qpos [5], for rendering."""
        return jnp.concatenate([state.info["pose"], state.obs[:2]])
