"""p(theta | y): where known objects lie, from contacts, by particles theta = (t, a) [N, 3].

    log w_i += log p(y | s, theta_i),   p(1 | s, theta) = map(s~),   s~ = R(a)' (s - t) + c

If the effective number falls below N/2, particles are resampled and made to differ by `kind`:

    metropolis  steps against all measurements, among them leaps onto the contact manifold: the
                posterior stays exact, as the objects rest (iterated batch importance sampling,
                Chopin 2002)
    local       the same steps without leaps
    jitter      theta' = theta + e,  e ~ N(0, diag(1 cm, 1 cm, 0.05 rad)^2): a plain filter
    manifold    after a contact at q a quarter of the particles is drawn onto the contact manifold,
                t' = q - R(a') (b - c),  a' = a_i + N(0, H_aa),  b a point of the outline,
                with weights p(t' | a') of the density p = sum_j w_j N(theta_j, H) before the
                contact; the others are jittered

The last one is the manifold particle filter (Koval, Pollard and Srinivasa 2015), which the thesis
uses, for an object at rest. The sizes of e and the share of a quarter are our choice; H is Scott's
rule plus the variance of e. A measurement at s informs by

    trace   E |dp/dtheta|^2 / (p (1 - p)),  angles in units of 1 / rho
    det     the determinant of E [dp/dtheta dp/dtheta' / (p (1 - p))]
    mutual  h(E p) - E h(p),  h the entropy of a binary variable

Source: thesis eq. (5.1) and section 5.3, with the information at s~ instead of s.
"""

from collections.abc import Callable
from typing import Annotated, Any, Literal, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import poses
from hybrid_rl.core.batching import when_any
from hybrid_rl.core.domain import Box
from hybrid_rl.fields import Count, Positive, has, part
from hybrid_rl.types import Spec

SHARE = 4  # one of so many particles is drawn onto the manifold
IMPOSSIBLE = -1e4  # log-weight of a pose that the prior excludes
NOISE = (0.01, 0.01, 0.05)  # [m, m, rad] standard deviation of e


class Cloud(NamedTuple):
    """Weighted particles."""

    theta: Array  # [N, 3]
    log_w: Array  # [N]
    log_like: Array  # [N] of all measurements


class Evidence(NamedTuple):
    """All measurements, and how likely they are."""

    s: Array  # [C, 2]
    y: Array  # [C]
    count: Array  # [] measurements
    touched: Array  # [] bool: the last one was new, and a contact
    chance: Callable[[Array, Array], Array]  # p(y = 1) [] for theta [3] at s [2]
    trust: float  # power of the likelihood

    def log_like(self, theta: Array) -> Array:
        """log p(all measurements | theta [3]) []."""
        p = jax.vmap(self.chance, (None, 0))(theta, self.s)
        return jnp.sum(jnp.where(self.filled, log_chance(p, self.y, self.trust), 0.0))

    @property
    def filled(self) -> Array:
        """[C] bool: which rows are measurements."""
        return jnp.arange(len(self.y)) < self.count

    @property
    def contacts(self) -> Array:
        """Log-weights [C] of a uniform choice among the contacts; -inf elsewhere."""
        return jnp.log(jnp.where(self.filled & (self.y > 0.5), 1.0, 0.0))


Renewal = Callable[[poses.Frame, Evidence, Cloud, Array], tuple[Cloud, Array]]


def log_chance(p: Array, y: Array, trust: float) -> Array:
    """log p(y) [...], to the power `trust`, of measurements y with chances p of a 1."""
    return trust * jnp.log(jnp.where(y > 0.5, p, 1 - p))


def resampled(cloud: Cloud, key: Array) -> Cloud:
    """As many particles of equal weight. The key is consumed."""
    drawn = poses.systematic(cloud.log_w, len(cloud.theta), jax.random.uniform(key))
    return Cloud(cloud.theta[drawn], jnp.zeros(len(drawn)), cloud.log_like[drawn])


def markov(chances: tuple[float, ...], moves: int) -> Renewal:
    """`moves` Metropolis steps; chances: of turn, walk and leap (core.poses)."""

    def renew(
        frame: poses.Frame, evidence: Evidence, cloud: Cloud, key: Array
    ) -> tuple[Cloud, Array]:
        known = jnp.any(jnp.isfinite(evidence.contacts))
        weights = jnp.where(known, evidence.contacts, 0.0)

        def one(theta: Array, log_like: Array, key: Array) -> tuple[Array, Array, Array]:
            choosing, proposing, accepting = jax.random.split(key, 3)
            contact = evidence.s[jax.random.categorical(choosing, weights)]
            new, ratio = poses.move(frame, theta, contact, known, chances, proposing)
            log_new = evidence.log_like(new)
            good = jnp.log(jax.random.uniform(accepting)) < ratio + log_new - log_like
            good = good & poses.inside(frame, new)
            return jnp.where(good, new, theta), jnp.where(good, log_new, log_like), good

        def step(carry: tuple[Array, Array], key: Array) -> tuple[tuple[Array, Array], Array]:
            keys = jax.random.split(key, len(carry[0]))
            theta, log_like, good = jax.vmap(one)(*carry, keys)
            return (theta, log_like), good.mean()

        shifting, moving = jax.random.split(key)
        first = resampled(cloud, shifting)
        (theta, log_like), accepted = jax.lax.scan(
            step, (first.theta, first.log_like), jax.random.split(moving, moves)
        )
        return Cloud(theta, first.log_w, log_like), accepted.mean()

    return renew


def jitter(frame: poses.Frame, evidence: Evidence, cloud: Cloud, key: Array) -> tuple[Cloud, Array]:
    """Noise that does not leave the prior, and the share of particles that moved."""
    shifting, moving = jax.random.split(key)
    first = resampled(cloud, shifting)
    noise = jnp.array([NOISE]) * jax.random.normal(moving, first.theta.shape)
    theta = first.theta + noise
    good = jax.vmap(poses.inside, (None, 0))(frame, theta)
    theta = jnp.where(good[:, None], theta.at[:, 2].set(poses.wrap(theta[:, 2])), first.theta)
    return Cloud(theta, first.log_w, jax.vmap(evidence.log_like)(theta)), good.mean()


def manifold(
    frame: poses.Frame, evidence: Evidence, cloud: Cloud, key: Array
) -> tuple[Cloud, Array]:
    """After a contact a quarter of the particles is drawn from its manifold; else jitter."""
    jittering, drawing = jax.random.split(key)
    plain, accepted = jitter(frame, evidence, cloud, jittering)
    q = evidence.s[jnp.maximum(evidence.count - 1, 0).astype(jnp.int32)]
    some = jnp.arange(0, len(cloud.theta), SHARE)  # of a systematic sample, so a sample itself
    p = jax.vmap(evidence.chance, (0, None))(cloud.theta, q)
    before = jax.nn.log_softmax(cloud.log_w - log_chance(p, jnp.ones(()), evidence.trust))
    onto, log_w = _on_manifold(frame, q, cloud.theta, before, len(some), drawing)
    possible = evidence.touched & jnp.any(log_w > IMPOSSIBLE)
    log_w = jax.nn.log_softmax(log_w) + jnp.log(float(len(some)))
    mixed = Cloud(
        plain.theta.at[some].set(onto),
        plain.log_w.at[some].set(log_w),
        plain.log_like.at[some].set(jax.vmap(evidence.log_like)(onto)),
    )
    return jax.tree.map(lambda a, b: jnp.where(possible, a, b), mixed, plain), accepted


def _on_manifold(
    frame: poses.Frame, q: Array, theta: Array, log_w: Array, count: int, key: Array
) -> tuple[Array, Array]:
    """Poses [count, 3] that touch q [2], and their log-density under particles theta [N, 3].

    log_w: [N] normalised log-weights of theta. The key is consumed.
    """
    shifting, turning, choosing = jax.random.split(key, 3)
    scale = _bandwidths(theta, jnp.exp(log_w))
    drawn = poses.systematic(log_w, count, jax.random.uniform(shifting))
    angle = theta[drawn, 2] + scale[2] * jax.random.normal(turning, (count,))
    b = frame.outline[jax.random.randint(choosing, (count,), 0, len(frame.outline))]
    t = q[None] - jax.vmap(poses.rotated)(b - frame.middle[None], angle)
    onto = jnp.column_stack([t, poses.wrap(angle)])

    def log_density(new: Array) -> Array:
        apart = (theta - new[None]).at[:, 2].set(poses.wrap(theta[:, 2] - new[2])) / scale[None]
        squares = -0.5 * apart**2
        both = jax.nn.logsumexp(log_w + squares.sum(1)) - jax.nn.logsumexp(log_w + squares[:, 2])
        return jnp.where(poses.inside(frame, new), both, IMPOSSIBLE)

    return onto, jax.vmap(log_density)(onto)


def _bandwidths(theta: Array, w: Array) -> Array:
    """The standard deviations [3] of H for particles [N, 3] with weights [N] that sum to 1."""
    mean, length = w @ theta[:, :2], poses.circular(theta[:, 2], w)[1]
    plane = w @ (theta[:, :2] - mean[None]) ** 2
    turn = jnp.minimum(-2 * jnp.log(jnp.maximum(length, 1e-6)), jnp.pi**2 / 3)
    scott = len(theta) ** (-2 / 7)
    return jnp.sqrt(scott * jnp.append(plane, turn) + jnp.array(NOISE) ** 2)


class Particles(NamedTuple):
    """The particles, and all measurements."""

    theta: Array  # [N, 3]
    log_w: Array  # [N]
    log_like: Array  # [N] of all measurements
    s: Array  # [C, 2]
    y: Array  # [C]
    count: Array  # [] measurements
    touched: Array  # [] bool: the last measurement was new, and a contact
    accepted: Array  # [] share of the last moves


@part
class PoseParticles:
    """A belief about the pose of objects.

    A full memory takes no more measurements (`belief/full` is 1).
    """

    map: Annotated[Any, has("chance", "must be a map of objects, such as map=known")]
    domain: Box  # bounds of t, of two coordinates
    particles: Count = 1000  # N
    capacity: Count = 400  # C
    moves: Count = 4  # Metropolis steps after a resampling
    every: Count = 10  # measurements between two looks at the effective number
    kind: Literal["metropolis", "local", "manifold", "jitter"] = "metropolis"  # see above
    trust: Positive = 1.0  # power of the likelihood
    measure: Literal["trace", "det", "mutual"] = "trace"
    subset: Count = 64  # particles in the information
    length: Positive = 0.3  # rho [m]

    @property
    def _frame(self) -> poses.Frame:
        """The frame of poses, as Metropolis moves need it."""
        low, high = jnp.array(self.domain.low), jnp.array(self.domain.high)
        return poses.Frame(low, high, jnp.array(self.map.middle), jnp.asarray(self.map.outline))

    def init(self, key: Array, spec: Spec) -> Particles:
        """Particles from the prior. The key is consumed."""
        theta = jax.vmap(lambda k: poses.draw(self._frame, k))(
            jax.random.split(key, self.particles)
        )
        none, empty = jnp.zeros(self.particles), jnp.zeros(self.capacity)
        zero = jnp.zeros(())
        s, touched = jnp.zeros((self.capacity, 2)), jnp.zeros((), bool)
        return Particles(theta, none, none, s, empty, zero, touched, zero)

    def _chance(self, theta: Array, s: Array) -> Array:
        """p(y = 1) [] at s [2] if the objects are at theta [3]."""
        return self.map.chance(poses.to_map(theta, s, jnp.array(self.map.middle)))

    def add(self, state: Particles, s: Array, y: Array, key: Array) -> Particles:
        """The belief after y [], 0 or 1, was measured at s [2]. The key is consumed."""
        room = state.count < self.capacity
        slot = jnp.minimum(state.count, self.capacity - 1).astype(jnp.int32)
        p = jax.vmap(self._chance, (0, None))(state.theta, s)
        each = jnp.where(room, log_chance(p, y, self.trust), 0.0)
        state = state._replace(
            log_w=state.log_w + each,
            log_like=state.log_like + each,
            s=state.s.at[slot].set(jnp.where(room, s, state.s[slot])),
            y=state.y.at[slot].set(jnp.where(room, y, state.y[slot])),
            count=state.count + room,
            touched=room & (y > 0.5),
        )
        return when_any(self._due, self._renew)(state, key)

    def _due(self, state: Particles) -> Array:
        """[] bool: whether to resample."""
        few = poses.effective(state.log_w) < self.particles / 2
        due = few & (state.count % self.every == 0)
        return due | state.touched if self.kind == "manifold" else due

    def _renew(self, state: Particles, key: Array) -> Particles:
        """Resampled and moved particles; the same ones where none is due. The key is consumed."""
        before = Cloud(state.theta, state.log_w, state.log_like)
        evidence = Evidence(state.s, state.y, state.count, state.touched, self._chance, self.trust)
        renewal: dict[str, Renewal] = {
            "metropolis": markov(poses.CHANCES, self.moves),
            "local": markov(poses.NO_LEAPS, self.moves),
            "manifold": manifold,
            "jitter": jitter,
        }
        cloud, accepted = renewal[self.kind](self._frame, evidence, before, key)
        renewed = state._replace(**cloud._asdict(), accepted=accepted)
        due = self._due(state)
        return jax.tree.map(lambda new, old: jnp.where(due, new, old), renewed, state)

    def predict(self, state: Particles, s: Array) -> tuple[Array, Array]:
        """p(y = 1) and the standard deviation [] of y at s [2]."""
        p = jax.vmap(self._chance, (0, None))(state.theta, s)
        p = jax.nn.softmax(state.log_w) @ p
        return p, jnp.sqrt(p * (1 - p))

    def loss(self, state: Particles, s: Array, y: Array) -> Array:
        """-log p(y | s) [nat] at s [2], before y [] is added."""
        p, _ = self.predict(state, s)
        return -jnp.log(jnp.where(y > 0.5, p, 1 - p))

    def _subset(self, state: Particles) -> Array:
        """Particles [subset, 3] in proportion to their weights."""
        return state.theta[poses.systematic(state.log_w, self.subset, jnp.float32(0.5))]

    def information(self, state: Particles, s: Array) -> Array:
        """The information [] of a measurement at s [2], by `measure`."""
        if self.measure == "mutual":
            return self.gain(state, s)
        value = jax.vmap(jax.value_and_grad(self._chance), (0, None))
        p, g = value(self._subset(state), s)
        g = g / jnp.array([[1.0, 1.0, self.length]]) / jnp.sqrt(p * (1 - p))[:, None]
        if self.measure == "trace":
            return jnp.mean(jnp.sum(g**2, -1))
        a, b, c = jnp.mean(g[:, :, None] * g[:, None, :], 0)
        return jnp.maximum(a @ jnp.cross(b, c), 0.0)

    def gain(self, state: Particles, s: Array) -> Array:
        """The mutual information [nat] of the pose and a measurement at s [2]."""
        p = jax.vmap(self._chance, (0, None))(self._subset(state), s)
        return jnp.maximum(_entropy(p.mean()) - _entropy(p).mean(), 0.0)

    def gain_along(self, state: Particles, path: Array) -> Array:
        """H(w) - H(w | y+) [nat] [], y+ the likelier measurement at each position of path [T, 2].

        It may be negative: the particles that y+ favours can be more.
        """
        theta = self._subset(state)
        p = jax.vmap(jax.vmap(self._chance, (None, 0)), (0, None))(theta, path)
        expected = (p.mean(0) > 0.5).astype(p.dtype)[None]
        log_w = jax.nn.log_softmax(log_chance(p, expected, self.trust).sum(1))
        return jnp.log(float(self.subset)) + jnp.sum(jnp.exp(log_w) * log_w)

    def informed(self, state: Particles) -> Array:
        """[] bool: whether any measurement was 1."""
        return jnp.any((state.y > 0.5) & (jnp.arange(self.capacity) < state.count))

    def report(self, state: Particles) -> dict[str, Array]:
        """The mean pose, its spread, the most likely particle, and the filter's health."""
        w = jax.nn.softmax(state.log_w)
        x, y = w @ state.theta[:, :2]
        angle, length = poses.circular(state.theta[:, 2], w)
        best = state.theta[jnp.argmax(state.log_like)]
        spread = jnp.sqrt(w @ jnp.sum((state.theta[:, :2] - jnp.stack([x, y])[None]) ** 2, -1))
        return {
            "belief/mean_x": x,
            "belief/mean_y": y,
            "belief/mean_angle": angle,
            "belief/best_x": best[0],
            "belief/best_y": best[1],
            "belief/best_angle": best[2],
            "belief/spread_position": spread,
            "belief/spread_angle": jnp.sqrt(-2 * jnp.log(jnp.clip(length, 1e-6, 1.0))),
            "belief/effective": poses.effective(state.log_w),
            "belief/accepted": state.accepted,
            "belief/full": (state.count >= self.capacity).astype(jnp.float32),
        }


def _entropy(p: Array) -> Array:
    """h [nat] of binary variables with probabilities p [...]."""
    return -p * jnp.log(p) - (1 - p) * jnp.log1p(-p)
