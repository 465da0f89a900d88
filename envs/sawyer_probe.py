"""Sawyer probes objects on a table with a rod, which feels only that it touches one.

    dp_c/dt = v_c,   dv_c/dt = a u - b v_c      the command, in the plane of the table
    twist = v_c + k (p_c - p)                   of the tip, by damped least squares
    r = y: whether the force between rod and objects was above 0, 0 or 1

o = (p, v) [4]: position [m] and velocity [m/s] of the rod's tip in the plane; the rod is held
upright, at a constant height. The command leads the tip by `lead` at most and then loses its
velocity away from the tip, so that the arm presses gently; 5 cm outside of the box [low, high] it
stops. A decision is 0.1 s in ten commands of two physics steps. Objects do not move; they are
rounded boxes in a pose theta, as in `contact_plane`. Start: at rest, uniform in the box, clear of
the objects. Never terminates.
Metrics: touch, which is y; pose_x, pose_y and pose_angle, theta.

Source: thesis section 5.3 (a robot that feels contact); arm and servos are those of `sawyer_push`.
Objects, box, a, b, k and `lead` are our choice.
"""

from functools import cached_property
from typing import ClassVar

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic.contact_plane import ContactPlane, drawn, metrics_of, solid
from hybrid_rl.envs.analytic.point_mass import DT, move
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import Chain, joint_rates, quat_multiply, rotate
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState, Simulator
from hybrid_rl.envs.sawyer_push import HOME
from hybrid_rl.fields import NotNegative, Positive, part
from hybrid_rl.types import EnvState, Spec

ASSET = "sawyer_probe.xml"
COMMANDS, STEPS = 10, 2  # of a decision; physics steps of a command
EDGE = 0.05  # [m] from the box to the edge of the workspace
HALF = 0.03  # [m] half height of the objects
ITERATIONS = 30  # of the inverse kinematics at the start
TIP = Chain(ASSET, "tip")
THREE = (  # a disc, a box and a bar, without symmetry
    (0.64, 0.13, 0.0, 0.045, 0.045, 0.045),
    (0.62, -0.12, 0.4, 0.04, 0.028, 0.006),
    (0.45, 0.03, 1.2, 0.055, 0.016, 0.006),
)


@part
class SawyerProbe:
    """Sawyer among fixed objects; `physics` is native, mjx, warp or auto."""

    physics: Simulator = "auto"
    objects: tuple[tuple[float, ...], ...] = THREE
    acceleration: Positive = 0.3  # [m/s^2] a
    drag: NotNegative = 0.5  # [1/s] b
    low: tuple[float, float] = (0.35, -0.25)  # [m] of the box: x, y
    high: tuple[float, float] = (0.75, 0.25)
    theta: tuple[float, float, float] | None = None  # [m, m, rad]; None: the reference arrangement
    lead: Positive = 0.01  # [m] of the command before the tip
    track: Positive = 5.0  # [1/s] k
    hold: Positive = 10.0  # [1/s] gain on height and orientation
    posture: NotNegative = 0.5  # [1/s] gain on the initial posture, in the null space
    damping: Positive = 0.02  # of the least squares, for [m] and [rad]
    radius: ClassVar[float] = 0.012  # [m] of the rod

    spec = Spec(obs=4, act=2, dt=DT)

    def __post_init__(self) -> None:
        _ = self._plane  # whose fields it checks

    @cached_property
    def _plane(self) -> ContactPlane:
        names = "objects", "acceleration", "drag", "radius", "low", "high", "theta"
        return ContactPlane(**{name: getattr(self, name) for name in names})

    @cached_property
    def asset(self) -> str:
        """MJCF text of the arm, the table and the objects at theta."""
        cx, cy = ((a + b) / 2 for a, b in zip(self.low, self.high, strict=True))
        x, y, angle = self.theta or (cx, cy, 0.0)
        centred = tuple((a - cx, b - cy, *shape) for a, b, *shape in self.objects)
        geoms, pairs = solid(centred, "rod", HALF)
        body, site = 'name="objects" pos="0 0', '<site name="everywhere"'
        text = mjcf.text(ASSET).replace(body, f'name="objects" euler="0 0 {angle}" pos="{x} {y}')
        text = text.replace(site, f"{geoms}{drawn(centred, HALF)}{site}")
        return text.replace("</mujoco>", f"{pairs}</mujoco>")

    @property
    def _body(self) -> Physics:
        return Physics(self.asset, self.physics)

    def reset(self, key: Array) -> EnvState:
        """A random position of the tip, that of `contact_plane` for the same key."""
        x, _, pose, _ = self._plane.reset(key).data
        data = self._body.reset(self._reached(x[:2], jnp.array(HOME)), jnp.zeros(7))
        tip = TIP.pose(data.qpos)[0][:2]
        info = {"command": jnp.concatenate([tip, jnp.zeros(2)]), "pose": pose}
        return self._state(data, jnp.zeros(()), info)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [2] in [-1, 1]."""
        push, body = self.acceleration * jnp.clip(action, -1.0, 1.0), self._body

        def command(carry: tuple[PhysicsState, Array], _: None) -> tuple:
            data, c = carry
            pose = TIP.pose(data.qpos)
            tip = pose[0][:2]
            c = self._led(move(c, push, self.drag, DT / COMMANDS), tip)
            velocity = c[2:] + self.track * (c[:2] - tip)
            data = body.step(data, self._rates(data.qpos, pose, velocity), STEPS)
            return (data, c), body.sensor(data, "touch")[0]

        first = state.data, state.info["command"]
        (data, c), force = jax.lax.scan(command, first, None, length=COMMANDS)
        touch = (force > 0).any().astype(jnp.float32)
        touch = jnp.where(jnp.isfinite(data.qpos).all(), touch, jnp.nan)  # no contact hides a NaN
        return self._state(data, touch, {**state.info, "command": c})

    def _led(self, c: Array, tip: Array) -> Array:
        """The command [4] in the workspace and near the tip [2], without velocity out of these."""
        low, high = jnp.array(self.low) - EDGE, jnp.array(self.high) + EDGE
        inside = jnp.clip(c[:2], low, high)
        v = jnp.where(c[:2] == inside, c[2:], 0.0)
        ahead = inside - tip
        away = jnp.sqrt((ahead**2).sum() + 1e-12)
        taut = away > self.lead
        v = v - jnp.where(taut, jnp.maximum(v @ ahead, 0) / away**2, 0.0) * ahead
        return jnp.concatenate([jnp.where(taut, tip + self.lead / away * ahead, inside), v])

    def _rates(self, qpos: Array, pose: tuple[Array, Array, Array], velocity: Array) -> Array:
        """Joint velocities [7] [rad/s] that move the tip from `pose` by `velocity` [2] [m/s]."""
        home, leaning = TIP.constant_pose(HOME)
        rise = self.hold * (jnp.asarray(home[2:]) - pose[0][2:])
        linear, away = jnp.concatenate([velocity, rise]), jnp.asarray(HOME, jnp.float32) - qpos
        return joint_rates(pose, linear, _upright(jnp.asarray(leaning)), away, self)

    def _reached(self, p: Array, q: Array) -> Array:
        """Angles [7] that bring the tip to p [2], by Newton's method from q [7]."""

        def newton(q: Array, _: None) -> tuple[Array, None]:
            pose = TIP.pose(q)
            return q + self._rates(q, pose, self.hold * (p - pose[0][:2])) / self.hold, None

        return jax.lax.scan(newton, q, None, length=ITERATIONS)[0]

    def _state(self, data: PhysicsState, touch: Array, info: dict[str, Array]) -> EnvState:
        tip, _, jacobian = TIP.pose(data.qpos)
        obs = jnp.concatenate([tip[:2], jacobian[:2] @ data.qvel])
        return EnvState(data, obs, touch, metrics=metrics_of(touch, info["pose"]), info=info)

    def distance(self, s: Array, pose: Array | None = None) -> Array:
        """Signed distance [] [m] of s [2] to the nearest surface; `pose` [3] is theta."""
        return self._plane.distance(s, pose)

    def points(self, state: EnvState, obs: Array) -> Array:
        """Positions [T+1, 1, 3] [m] of the tip along observations [T+1, 4], for drawing."""
        height = jnp.broadcast_to(TIP.pose(state.data.qpos)[0][2], (len(obs), 1))
        return jnp.concatenate((obs[:, :2], height), 1)[:, None]

    def pose(self, state: EnvState) -> Array:
        """Joint positions qpos [7] for rendering, at which the tip is where it was observed."""
        return self._reached(state.obs[:2], state.data.qpos)


def _upright(rotation: Array) -> Array:
    """The rotation [4] of the tip next to `rotation` [4] in which the rod points down."""
    axis = rotate(rotation, jnp.array([0.0, 0.0, 1.0]))
    swing = jnp.stack([1 - axis[2], -axis[1], axis[0], jnp.zeros(())])  # axis x down
    return quat_multiply(swing / jnp.linalg.norm(swing), rotation)
