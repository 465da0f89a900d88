"""Contact plane: a ball rolls among solid objects and feels only whether it touches one.

    dp/dt = v,   dv/dt = a u - b v,   a contact removes the velocity into the object: no bounce
    r = y, the measured contact, 0 or 1

o = (p, v) [4] in m and m/s. Objects are rounded boxes (x, y, angle, half width, half height,
rounding) in their reference arrangement; theta = (t, a) moves all of them,

    s~ = R(a)' (s - t) + c,   c the middle of the box [low, high]

from a position s to one among the objects in their reference arrangement; theta is drawn from
`theta` +- `spread` at the reset. Start: at rest, uniform in the box, outside of the objects; a
decision is 0.1 s in ten steps; never terminates; there are no walls. y is the contact of any of
the steps, wrong with probability `missed` after a contact and `false_contact` |u - u_before| / 2
without one.
Metrics: touch, the true contact; pose_x, pose_y and pose_angle, theta.

Source: thesis sections 5.3 and 5.4: a second-order point among fixed objects, false contacts in
quick movements. Objects, their sizes, a, b and the error rates are our choice.
"""

import math
from dataclasses import KW_ONLY
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.poses import rotated, to_map
from hybrid_rl.envs.analytic.point_mass import DT, move
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.fields import Discount, NotNegative, Positive, check_span, part
from hybrid_rl.types import EnvState, Spec

Shape = tuple[float, ...]  # x, y, angle, half width, half height, rounding [m, rad]
LEAST = 1e-4  # [m] least half width of a box, and difference of heights
HALF = 0.03  # [m] half height of the objects, as they are drawn
SUBSTEPS, CORNER = 10, 2  # steps of a decision; projections of a step, for corners of two objects
STARTS, CLEAR = 64, 0.02  # candidates for the start; from a surface, in the box's shorter side
THREE = (  # a disc, a box and a bar, without symmetry
    (0.25, 0.72, 0.0, 0.10, 0.10, 0.10),
    (0.72, 0.68, 0.4, 0.09, 0.06, 0.01),
    (0.50, 0.25, -0.3, 0.12, 0.03, 0.01),
)


class Body(NamedTuple):
    """The ball and its sensor."""

    x: Array  # [4]
    u: Array  # [2] the previous action
    pose: Array  # [3] theta
    noise: Array  # [2] uint32, a key for the sensor's errors


@part
class ContactPlane:
    """A ball among objects, with a binary contact sensor."""

    _: KW_ONLY
    objects: tuple[tuple[float, ...], ...] = THREE
    acceleration: Positive = 1.0  # [m/s^2] a
    drag: NotNegative = 0.0  # [1/s] b
    radius: Positive = 0.03  # [m] of the ball
    low: tuple[float, float] = (0.0, 0.0)  # [m]
    high: tuple[float, float] = (1.0, 1.0)
    theta: tuple[float, float, float] | None = None  # [m, m, rad]; None: the reference arrangement
    spread: tuple[float, float, float] = (0.0, 0.0, 0.0)  # of theta at the reset
    false_contact: Discount = 0.0  # probability for |u - u_before| = 2
    missed: Discount = 0.0  # probability

    spec = Spec(obs=4, act=2, dt=DT)

    def __post_init__(self) -> None:
        check_span(self)
        for shape in self.objects:
            _check(shape, self.low, self.high)

    @property
    def middle(self) -> Array:
        """c [2] [m]."""
        return (jnp.array(self.low) + jnp.array(self.high)) / 2

    def reset(self, key: Array) -> EnvState:
        """A random position and pose."""
        none = jnp.zeros(())
        return self._state(self._start(key), none, none)

    def _start(self, key: Array) -> Body:
        """At rest and clear of the objects, whose pose is random."""
        posing, starting, noise = jax.random.split(key, 3)
        pose = jnp.append(self.middle, 0.0) if self.theta is None else jnp.array(self.theta)
        pose = pose + jnp.array(self.spread) * jax.random.uniform(posing, (3,), minval=-1, maxval=1)
        low, high = jnp.array(self.low), jnp.array(self.high)
        starts = jax.random.uniform(starting, (STARTS, 2), minval=low, maxval=high)
        gap = self.radius + CLEAR * jnp.min(high - low)
        clear = jax.vmap(lambda s: self.distance(s, pose))(starts) > gap
        x = jnp.concatenate([starts[jnp.argmax(clear)], jnp.zeros(2)])
        return Body(x, jnp.zeros(2), pose, jax.random.key_data(noise))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [2] in [-1, 1]."""
        body: Body = state.data
        u, pose = jnp.clip(action, -1.0, 1.0), body.pose

        def substep(carry: tuple[Array, Array], _: None) -> tuple[tuple[Array, Array], None]:
            x, touched = carry
            x = move(x, self.acceleration * u, self.drag, DT / SUBSTEPS)
            for _corner in range(CORNER):
                d, normal = jax.value_and_grad(self.distance)(x[:2], pose)
                p = x[:2] + (self.radius - d) * normal  # outside of the objects, without
                v = x[2:] - jnp.minimum(x[2:] @ normal, 0) * normal  # velocity into them
                x = jnp.where(d < self.radius, jnp.concatenate([p, v]), x)
                touched = touched | (d < self.radius)
            return (x, touched), None

        first = body.x, jnp.zeros((), bool)
        (x, touched), _ = jax.lax.scan(substep, first, None, length=SUBSTEPS)
        touch = touched.astype(jnp.float32)
        measured, noise = self.measured(touch, u - body.u, x, body.noise)
        return self._state(Body(x, u, pose, noise), touch, measured)

    def measured(self, touch: Array, change: Array, x: Array, noise: Array) -> tuple[Array, Array]:
        """y [] of the sensor for contact `touch` [] at x, and data of the key of its next error.

        change: [2] of the action. noise: data of a key, which is consumed.
        """
        later, drawing = jax.random.split(jax.random.wrap_key_data(noise))
        false = self.false_contact * jnp.linalg.norm(change) / 2
        wrong = jax.random.uniform(drawing) < jnp.where(touch > 0, self.missed, false)
        y = jnp.where(wrong, 1 - touch, touch)
        y = jnp.where(jnp.isfinite(x).all(), y, jnp.nan)  # no contact hides a NaN
        return y, jax.random.key_data(later)

    def _state(self, body: Body, touch: Array, measured: Array) -> EnvState:
        return EnvState(body, body.x, measured, metrics=metrics_of(touch, body.pose))

    def distance(self, s: Array, pose: Array | None = None) -> Array:
        """Signed distance [] [m] of s [2] to the nearest surface; `pose` [3] is theta."""
        if pose is not None:
            s = to_map(pose, s, self.middle)
        each = [rounded_box(s, *shape) for shape in self.objects]
        return jnp.min(jnp.stack(each)) if each else jnp.float32(jnp.inf)

    def scene(self) -> str:
        """MJCF text of the scene for rendering."""
        x, y = ((a + b) / 2 for a, b in zip(self.low, self.high, strict=True))
        about = tuple((shape[0] - x, shape[1] - y, *shape[2:]) for shape in self.objects)
        geoms = drawn(about, HALF)
        text = mjcf.text("contact_plane.xml").replace('<geom name="object" size="1"/>', geoms)
        edges = zip(("WEST", "SOUTH", "EAST", "NORTH"), (*self.low, *self.high), strict=True)
        for name, value in edges:
            text = text.replace(name, f"{value:g}")
        return text.replace("RADIUS", f"{self.radius:g}")

    def pose(self, state: EnvState) -> Array:
        """theta and the position of the ball, qpos [5], for rendering."""
        return jnp.concatenate([state.data.pose, state.obs[:2]])


def metrics_of(touch: Array, pose: Array) -> dict[str, Array]:
    """The metrics of a true contact `touch` [] at theta = `pose` [3]."""
    x, y, angle = pose
    return {"touch": touch, "pose_x": x, "pose_y": y, "pose_angle": angle}


def rounded_box(
    s: Array, x: float, y: float, angle: float, half_x: float, half_y: float, rounding: float
) -> Array:
    """Signed distance [] of s [2] to the surface of a rounded box."""
    local = rotated(s - jnp.array([x, y]), jnp.float32(-angle))
    q = jnp.abs(local) - jnp.array([half_x - rounding, half_y - rounding])
    squares = jnp.sum(jnp.maximum(q, 0) ** 2)
    outside = jnp.where(squares > 0, jnp.sqrt(jnp.where(squares > 0, squares, 1.0)), 0.0)
    return outside + jnp.minimum(jnp.max(q), 0) - rounding


def _check(shape: tuple[float, ...], low: tuple[float, ...], high: tuple[float, ...]) -> None:
    """Raise ValueError unless `shape` is a rounded box whose middle lies between low and high."""
    sound = len(shape) == 6 and 0 < shape[5] <= min(shape[3:5])
    if not (sound and all(a < s < b for a, s, b in zip(low, shape, high, strict=False))):
        raise ValueError(
            f"objects={list(shape)}: each is x, y, in the box, angle, half width, half height, and "
            "a rounding above 0 that is at most the smaller half"
        )


def solid(objects: tuple[Shape, ...], robot: str, height: float) -> tuple[str, str]:
    """Geoms of objects that are 2 `height` [m] high around z = 0, and contacts with geom `robot`.

    MJX has no contact with cylinders, so that a disc is an upright capsule, longer than the boxes
    are high: a robot at half height meets its straight part.

    Their names are object_0_0, object_0_1, ... of the first, object_1_0, ... of the second.
    """
    geoms, pairs = [], []
    for i, shape in enumerate(objects):
        for j, each in enumerate(_parts(shape, height, "capsule")):
            geoms.append(f'<geom name="object_{i}_{j}" {each} group="3"/>')
            pairs.append(f'<pair geom1="{robot}" geom2="object_{i}_{j}"/>')
    return "".join(geoms), f"<contact>{''.join(pairs)}</contact>"


def drawn(objects: tuple[Shape, ...], height: float) -> str:
    """Geoms of the same objects without contacts, of material "object"."""
    parts = [each for shape in objects for each in _parts(shape, height, "cylinder")]
    return "".join(f'<geom {each} mass="0" material="object"/>' for each in parts)


def _parts(shape: Shape, height: float, disc: str) -> list[str]:
    """Type, size and pose of each part."""
    x, y, angle, half_x, half_y, rounding = shape
    inner_x, inner_y = half_x - rounding, half_y - rounding
    sizes = [(half_x, inner_y), (inner_x, half_y)]
    parts = [
        f'type="box" size="{a:.9g} {b:.9g} {height - i * LEAST:g}" pos="{x:.9g} {y:.9g} 0" '
        f'euler="0 0 {angle:.9g}" contype="0" conaffinity="0"'
        for i, (a, b) in enumerate(sizes)
        if min(a, b) > LEAST  # one lower than the other, or their tops would flicker
    ]
    cos, sin = math.cos(angle), math.sin(angle)
    for a, b in sorted({(i * inner_x, j * inner_y) for i in (-1, 1) for j in (-1, 1)}):
        at = f"{x + cos * a - sin * b:.9g} {y + sin * a + cos * b:.9g} 0"
        size = f"{rounding:.9g} {height:g}"
        parts.append(f'type="{disc}" size="{size}" pos="{at}" contype="0" conaffinity="0"')
    return parts
