"""Poses theta = (t, a) of a plane [3]: weighted particles, and Metropolis moves between them.

    s~ = R(a)' (s - t) + c,   s = R(a) (s~ - c) + t

map positions s to the frame of a map whose middle is c, and back. Three moves keep a posterior
invariant if they are accepted by the ratio that `move` returns and that of posterior densities; L
is the shorter side of the box of t:

    walk  t' = t + d L e,  a' = a + 4 d e_3,  d log-uniform in [0.003, 0.3]
    turn  about a contact q: t' = q + R(e) (t - q), a' = a + e; the contact stays one
    leap  onto the contact: a' uniform, b a point of the outline, t' = q - R(a') (b - c) + e

The leap is the proposal of the manifold particle filter (Koval, Pollard and Srinivasa 2015), here
with its density, so that it is exact for an object at rest.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

SCALES = (0.003, 0.3)  # of a walk, in L; angles [rad] are four times as large
TURN = 0.5  # [rad] standard deviation
NEAR = 0.01  # standard deviation of a leap's contact, in L
PRIOR = 0.05  # share of leaps that are drawn from the prior
CHANCES = (0.35, 0.25, 0.4)  # of turn, walk and leap
NO_LEAPS = (0.6, 0.4, 0.0)


class Frame(NamedTuple):
    """What a move needs to know."""

    low: Array  # [2] bounds of t
    high: Array  # [2]
    middle: Array  # [2] c
    outline: Array  # [M, 2] positions of contact in the map's frame

    @property
    def side(self) -> Array:
        """L []."""
        return jnp.min(self.high - self.low)


def rotated(s: Array, angle: Array) -> Array:
    """s [2] rotated by an angle [] [rad]."""
    sin, cos = jnp.sin(angle), jnp.cos(angle)
    return jnp.stack([cos * s[0] - sin * s[1], sin * s[0] + cos * s[1]])


def to_map(theta: Array, s: Array, middle: Array) -> Array:
    """s~ [2] of a position s [2]."""
    return rotated(s - theta[:2], -theta[2]) + middle


def from_map(theta: Array, s: Array, middle: Array) -> Array:
    """The position [2] of s~ [2]."""
    return rotated(s - middle, theta[2]) + theta[:2]


def wrap(angle: Array) -> Array:
    """The angle in [-pi, pi)."""
    return (angle + jnp.pi) % (2 * jnp.pi) - jnp.pi


def draw(frame: Frame, key: Array) -> Array:
    """theta [3] from the prior: t uniform between the bounds, a in [-pi, pi)."""
    unit = jax.random.uniform(key, (3,))
    t = frame.low + (frame.high - frame.low) * unit[:2]
    return jnp.append(t, 2 * jnp.pi * unit[2] - jnp.pi)


def inside(frame: Frame, theta: Array) -> Array:
    """[] bool: whether the prior density of theta [3] is above 0."""
    return jnp.all((frame.low <= theta[:2]) & (theta[:2] <= frame.high))


def log_leap(frame: Frame, theta: Array, contact: Array) -> Array:
    """log density [] of theta [3] under a leap onto `contact` [2]."""
    touching = jax.vmap(from_map, (None, 0, None))(theta, frame.outline, frame.middle)
    variance = (NEAR * frame.side) ** 2
    squares = jnp.sum((touching - contact[None]) ** 2, -1) / variance
    count, volume = len(frame.outline), jnp.prod(frame.high - frame.low)
    near = jax.nn.logsumexp(-0.5 * squares) - jnp.log(2 * jnp.pi * variance * count)
    density = jnp.logaddexp(near + jnp.log1p(-PRIOR), jnp.log(PRIOR / volume))
    return density - jnp.log(2 * jnp.pi)


def move(
    frame: Frame, theta: Array, contact: Array, known: Array, chances: tuple[float, ...], key: Array
) -> tuple[Array, Array]:
    """A proposal theta' [3], and log q(theta) - log q(theta') [] of its densities.

    contact: [2] a position where a contact was measured. Without one (`known` [] is false) the
    proposal is a walk. chances: of turn, walk and leap. The key is consumed.
    """
    choosing, scaling, walking, turning, leaping = jax.random.split(key, 5)
    low, high = jnp.log(SCALES[0]), jnp.log(SCALES[1])
    scale = jnp.exp(jax.random.uniform(scaling, minval=low, maxval=high))
    units = jnp.stack([frame.side, frame.side, jnp.float32(4.0)])
    walked = theta + scale * units * jax.random.normal(walking, (3,))

    angle = TURN * jax.random.normal(turning)
    turned = jnp.append(contact + rotated(theta[:2] - contact, angle), theta[2] + angle)

    drawing, which, nearby, mixing = jax.random.split(leaping, 4)
    prior = draw(frame, drawing)
    b = frame.outline[jax.random.randint(which, (), 0, len(frame.outline))]
    error = NEAR * frame.side * jax.random.normal(nearby, (2,))
    t = contact - rotated(b - frame.middle, prior[2]) + error
    onto = jnp.append(t, prior[2])
    leapt = jnp.where(jax.random.uniform(mixing) < PRIOR, prior, onto)

    kind = jax.random.choice(choosing, 3, p=jnp.array(chances))
    kind = jnp.where(known, kind, 1)
    proposal = jnp.stack([turned, walked, leapt])[kind]
    proposal = proposal.at[2].set(wrap(proposal[2]))
    ratio = log_leap(frame, theta, contact) - log_leap(frame, proposal, contact)
    return proposal, jnp.where(kind == 2, ratio, 0.0)


def effective(log_w: Array) -> Array:
    """1 / sum_i w_i^2 [] of log-weights [N], up to a constant."""
    return 1 / jnp.sum(jax.nn.softmax(log_w) ** 2)


def systematic(log_w: Array, count: int, shift: Array) -> Array:
    """Indices [count] of particles with log-weights [N], drawn with one `shift` [] in [0, 1).

    Particle i is drawn floor(count w_i) or ceil(count w_i) times (Kitagawa 1996).
    """
    total = jnp.cumsum(jax.nn.softmax(log_w))
    marks = (jnp.arange(count) + shift) / count * total[-1]
    marks = jnp.minimum(marks, jnp.nextafter(total[-1], 0.0))  # where it was rounded up to the sum
    return jnp.searchsorted(total, marks, side="right")


def circular(angle: Array, w: Array) -> tuple[Array, Array]:
    """Mean [rad] and resultant length [] of angles [N] with weights w [N] that sum to 1."""
    sin, cos = w @ jnp.sin(angle), w @ jnp.cos(angle)
    return jnp.arctan2(sin, cos), jnp.hypot(sin, cos)
