"""Quadcopter: recover from a fall and hover, or track a target; a free body with four motors.

    hover   r = -(|g - g*|^2 + |w|^2 + 5 |v|^2 + |u - u*|^2) dt
    track   r = that of hover - 5 |p - p*|^2 dt, with v relative to the target

    g = R'(0, 0, -9.81): gravity in the body frame; g* = (0, 0, -9.81) when level
    w, v: angular and linear velocity in the body frame
    u*_i = m g / (4 k_i): motor controls that hover, each with a quarter of the weight; m and k_i
    are those of the changed body, so u* may exceed 6 there: with a motor below 0.41, say

o = (g, w, v) [9], for track (g, w, v, R'(p* - p)) [12]; a: four motor controls, u = 6 a; start:
level, w and v ~ U(-2, 2); for track also p* - p ~ U(-2, 2), and the target moves at a constant
velocity ~ U(-1, 1) x target_speed. A decision is one step of 0.005 s; never terminates. success:
|w|^2 + |v|^2 (track: + |p* - p|^2) < 0.01.
`wind` accelerates the quadcopter along the world's x axis, by a change of its velocity before each
step.

Source: thesis section 7.3 and Appendix D, whose reward has |u|^2 instead of |u - u*|^2; targets
from section 6.3.2; the position's weight is our choice. Damping is in the thesis' code but not in
its equations; wind is our choice.
"""

from typing import Literal

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.body import Body
from hybrid_rl.envs.mujoco.kinematics import inverse, quat_multiply, rotate
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.fields import NotNegative, part
from hybrid_rl.types import EnvState, Spec

DT = 0.005  # [s] of a decision
MAX_CONTROL = 6.0  # of a motor
SUCCESS_ERROR = 0.01  # squared error below which the task is solved


@part
class Quadcopter(Body):
    """Quadcopter; `physics` is native, mjx, warp or auto; mass and inertia come from `asset`."""

    task: Literal["hover", "track"] = "hover"
    damping: bool = False  # air drag
    start_speed: NotNegative = 2.0  # [m/s, rad/s] largest in each direction
    target_distance: NotNegative = 2.0  # [m] largest in each direction; track only
    target_speed: NotNegative = 0.0  # [m/s] largest in each direction; track only
    wind: float = 0.0  # [m/s^2] acceleration along the world's x axis
    asset: str = "quadcopter.xml"  # another file needs the same actuators

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        return Spec(obs=9 if self.task == "hover" else 12, act=4, dt=DT)

    @property
    def _asset(self) -> str:
        return self.asset

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        key_twist, key_target, key_drift = jax.random.split(key, 3)
        speed, distance, drift = self.start_speed, self.target_distance, self.target_speed
        level = jnp.zeros(7, jnp.float32).at[3].set(1.0)
        qvel = jax.random.uniform(key_twist, (6,), jnp.float32, -speed, speed)
        target, velocity = jnp.zeros((2, 3), jnp.float32)
        if self.task == "track":
            target = jax.random.uniform(key_target, (3,), jnp.float32, -distance, distance)
            velocity = jax.random.uniform(key_drift, (3,), jnp.float32, -drift, drift)
        data = self._body.reset(level, qvel)
        info = {"target": target, "target_velocity": velocity}
        return self._state(data, jnp.float32(0.0), info).replace(reward=jnp.float32(0.0))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [4] in [-1, 1]."""
        u = MAX_CONTROL * jnp.clip(action, -1.0, 1.0)
        drag = jnp.full(6, float(self.damping), jnp.float32)
        data = state.data
        if self.wind:
            data = data.replace(qvel=data.qvel.at[0].add(DT * self.wind))
        data = self._body.step(data, jnp.concatenate((u, drag)), 1)
        target = state.info["target"] + DT * state.info["target_velocity"]
        effort = ((u - self.hovering) ** 2).sum()
        return self._state(data, effort, {**state.info, "target": target})

    @property
    def hovering(self) -> np.ndarray:
        """Motor controls u* [4] that balance the weight without a moment."""
        model = self._body.model
        thrust = model.actuator_gear[:4, 2] * model.actuator_gainprm[:4, 0]
        return model.body_mass.sum() * -model.opt.gravity[2] / (4 * thrust)

    def equilibrium(self) -> tuple[Array, Array]:
        """Hovering, for track at the target."""
        down = jnp.asarray(self._body.model.opt.gravity)
        obs = jnp.concatenate((down, jnp.zeros(self.spec.obs - 3)))
        return obs, jnp.asarray(self.hovering / MAX_CONTROL)

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Angular velocity [rad/s] and velocity [m/s] in the body's frame at obs [o].

        `motion` is both, one after the other.
        """
        return {"spin": obs[3:6], "velocity": obs[6:9], "motion": obs[3:9]}

    scene = mjcf.scene("quadcopter_scene.xml")

    def pose(self, state: EnvState) -> Array:
        """Joint positions qpos [10] for rendering: the quadcopter's, then the target's."""
        hidden = jnp.asarray((0.0, 0.0, -99.0), jnp.float32)  # below the ground
        target = state.info["target"] if self.task == "track" else hidden
        return jnp.concatenate((state.data.qpos, target))

    def points(self, state: EnvState, obs: Array) -> Array:
        """Positions [T+1, 1, 3] [m] along observations [T+1, o] from `state`, for drawing.

        By trapezoids, from the attitude and the position of `state`.
        """
        drift = state.info["target_velocity"]

        def ahead(at: tuple[Array, Array], now: Array) -> tuple[tuple[Array, Array], Array]:
            p, r = at
            before, after = now[:, 3:9]
            w = (before + after)[:3] / 2
            turned = quat_multiply(r, jnp.concatenate((jnp.ones(1), DT / 2 * w)))
            turned = turned / jnp.linalg.norm(turned)
            v = (rotate(r, before[3:]) + rotate(turned, after[3:])) / 2 + drift
            return (p + DT * v, turned), p + DT * v

        start = state.data.qpos[:3], state.data.qpos[3:]
        p = jax.lax.scan(ahead, start, jnp.stack((obs[:-1], obs[1:]), 1))[1]
        return jnp.concatenate((start[0][None], p))[:, None]

    def _state(self, data: PhysicsState, effort: Array, info: dict[str, Array]) -> EnvState:
        """State with observation, reward and metrics; effort: |u - u*|^2 of the decision."""
        to_body = inverse(data.qpos[3:7])
        down = jnp.asarray(self._body.model.opt.gravity, jnp.float32)
        g, w = rotate(to_body, down), data.qvel[3:]
        v = rotate(to_body, data.qvel[:3] - info["target_velocity"])
        away = rotate(to_body, info["target"] - data.qpos[:3])
        parts, cost = [g, w, v], ((g - down) ** 2).sum() + (w**2).sum() + 5 * (v**2).sum()
        error = (w**2).sum() + (v**2).sum()
        if self.task == "track":
            parts, cost = [*parts, away], cost + 5 * (away**2).sum()
            error = error + (away**2).sum()
        success = (error < SUCCESS_ERROR).astype(jnp.float32)
        metrics = {"success": success, "error": error}
        obs, reward = jnp.concatenate(parts), -DT * (cost + effort)
        return EnvState(data, obs, reward, metrics=metrics, info=info)
