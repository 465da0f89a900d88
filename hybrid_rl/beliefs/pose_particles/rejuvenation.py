"""Particles theta [N, 3] after resampling: three ways to make them differ again.

    markov    Metropolis steps against all measurements: the posterior stays exact, as the objects
              rest (iterated batch importance sampling, Chopin 2002)
    jitter    theta' = theta + e,  e ~ N(0, diag(1 cm, 1 cm, 0.05 rad)^2): a plain filter
    manifold  after a contact at q a quarter of the particles is drawn onto the contact manifold,
              t' = q - R(a') (b - c),  a' = a_i + N(0, H_aa),  b a point of the outline,
              with weights p(t' | a') of the density p = sum_j w_j N(theta_j, H) before the contact;
              the others are jittered

The last one is the manifold particle filter (Koval, Pollard and Srinivasa 2015), which the thesis
uses in section 5.3, for an object at rest. The sizes of e and the share of a quarter are our
choice; H is Scott's rule plus the variance of e.
"""

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import poses

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
    theta, good = _bounded(frame, first.theta + noise, first.theta)
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


def _bounded(frame: poses.Frame, new: Array, old: Array) -> tuple[Array, Array]:
    """new [N, 3] where the prior allows it, else old; which [N] are new."""
    good = jax.vmap(poses.inside, (None, 0))(frame, new)
    new = new.at[:, 2].set(poses.wrap(new[:, 2]))
    return jnp.where(good[:, None], new, old), good
