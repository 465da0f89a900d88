"""Quadcopter: catch a fall and hover, or follow a target; a free body and four motors.

    hover   r = -(|g - g*|^2 + |w|^2 + 5 |v|^2 + |u - u*|^2) dt
    track   r = as hover, and -5 |p - p*|^2 dt;   v: relative to the target's

    g = R'(0, 0, -9.81): gravity in the body's frame, where g* = (0, 0, -9.81) is level;
    w, v: angular and linear velocity in the body's frame; u* = m g / (4 k): thrust at rest

o = (g, w, v) [9], track: and R'(p* - p) [12]; a: four motors, as fractions of u = 6, or with
bidirectional=false from 0 to 6; start: level, w and v U(-2, 2); track: p* - p U(-2, 2), and
the target moves on at U(-1, 1) x target_speed. A decision is one step of 0.005 s; never
terminates. success: |o - o*|^2 < 0.01 over w and v (track: over w, v and p* - p).

Source: thesis, section 7.3 and Appendix D, whose reward has |u|^2, here less what hovering
needs; section 6.3.2 has the targets; the weight of the position is ours. The damping is in
the thesis' code, not in its equations.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import inverse, turn
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState, check
from hybrid_rl.envs.options import one_of
from hybrid_rl.types import EnvState, Spec

ASSET = "quadcopter.xml"
SCENE = "quadcopter_scene.xml"
DT = 0.005  # [s] of a decision
GREATEST = 6.0  # control of a motor
CLOSE = 0.01  # squared error of a success


@dataclass(frozen=True)
class Quadcopter:
    """Flies; `physics` is native, mjx, warp or auto. Mass and inertia are the asset's."""

    physics: str = "auto"
    task: str = "hover"  # or track
    damping: bool = False  # drag of the air
    bidirectional: bool = True  # motors pull as well
    start_speed: float = 2.0  # [m/s, rad/s] greatest, in each direction
    target_distance: float = 2.0  # [m] greatest, in each direction; track alone
    target_speed: float = 0.0  # [m/s] greatest, in each direction; track alone
    asset: str = ASSET  # one of your own needs the same motors and drags

    def __post_init__(self) -> None:
        one_of("task", self.task, ("hover", "track"))
        check(self.physics)

    @property
    def spec(self) -> Spec:
        """Sizes and rate."""
        return Spec(obs=9 if self.task == "hover" else 12, act=4, dt=DT)

    @property
    def _body(self) -> Physics:
        return Physics(self.asset, self.physics)

    def reset(self, key: Array) -> EnvState:
        """A first state, drawn with `key`."""
        key_twist, key_target, key_drift = jax.random.split(key, 3)
        fast, far, drift = self.start_speed, self.target_distance, self.target_speed
        level = jnp.zeros(7, jnp.float32).at[3].set(1.0)
        qvel = jax.random.uniform(key_twist, (6,), jnp.float32, -fast, fast)
        target, moving = jnp.zeros((2, 3), jnp.float32)
        if self.task == "track":
            target = jax.random.uniform(key_target, (3,), jnp.float32, -far, far)
            moving = jax.random.uniform(key_drift, (3,), jnp.float32, -drift, drift)
        data = self._body.reset(level, qvel)
        info = {"target": target, "target_velocity": moving}
        return self._state(data, jnp.float32(0.0), info).replace(reward=jnp.float32(0.0))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [4] in [-1, 1]."""
        action = jnp.clip(action, -1.0, 1.0)
        u = GREATEST * (action if self.bidirectional else (action + 1) / 2)
        drag = jnp.full(6, float(self.damping), jnp.float32)
        data = self._body.step(state.data, jnp.concatenate((u, drag)), 1)
        target = state.info["target"] + DT * state.info["target_velocity"]
        effort = ((u - self.hovering) ** 2).sum()
        return self._state(data, effort, {**state.info, "target": target})

    @property
    def hovering(self) -> float:
        """Control u* of each motor that carries the weight."""
        model = self._body.model
        thrust = model.actuator_gear[:4, 2].mean()
        return float(model.body_mass.sum() * -model.opt.gravity[2] / (4 * thrust))

    def scene(self) -> str:
        """MJCF text of the world as it is drawn."""
        return mjcf.text(SCENE)

    def pose(self, state: EnvState) -> Array:
        """Positions qpos [10] of the drawn world: of the quadcopter, and of the target."""
        hidden = jnp.asarray((0.0, 0.0, -99.0), jnp.float32)  # below the ground
        target = state.info["target"] if self.task == "track" else hidden
        return jnp.concatenate((state.data.qpos, target))

    def _state(self, data: PhysicsState, effort: Array, info: dict[str, Array]) -> EnvState:
        """effort: |u - u*|^2 of the decision."""
        to_body = inverse(data.qpos[3:7])
        down = jnp.asarray(self._body.model.opt.gravity, jnp.float32)
        g, w = turn(to_body, down), data.qvel[3:]
        v = turn(to_body, data.qvel[:3] - info["target_velocity"])
        away = turn(to_body, info["target"] - data.qpos[:3])
        parts, cost = [g, w, v], ((g - down) ** 2).sum() + (w**2).sum() + 5 * (v**2).sum()
        error = (w**2).sum() + (v**2).sum()
        if self.task == "track":
            parts, cost = [*parts, away], cost + 5 * (away**2).sum()
            error = error + (away**2).sum()
        no, success = jnp.zeros((), bool), (error < CLOSE).astype(jnp.float32)
        reward = -DT * (cost + effort)
        obs = jnp.concatenate(parts)
        return EnvState(data, obs, reward, no, no, {"success": success, "error": error}, info)
