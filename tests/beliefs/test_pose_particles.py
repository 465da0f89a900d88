"""The pose of objects by particles, against a Bayes filter on a grid and against enumeration."""

from dataclasses import replace
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.beliefs.maps.known import KnownMap
from hybrid_rl.beliefs.pose_particles import PoseParticles
from hybrid_rl.core.domain import Box
from hybrid_rl.envs.analytic.contact_plane import ContactPlane
from hybrid_rl.types import Spec

pytestmark = pytest.mark.turns(4)

SPEC = Spec(obs=4, act=2, dt=0.1)
SHAPES = ((0.35, 0.6, 0.3, 0.2, 0.06, 0.02), (0.62, 0.4, 0.0, 0.05, 0.05, 0.05))
WORLD = ContactPlane(objects=SHAPES)
MAP = KnownMap(WORLD, width=0.03, low=0.05, high=0.95)
BOX = Box((0, 1), (0.3, 0.3), (0.7, 0.7))
BELIEF = PoseParticles(MAP, BOX, particles=1500, capacity=60, every=5)
TRUE = np.array([0.45, 0.55, 0.9])


def distance(theta, s):
    """Distance [N, M] of s [M, 2] from the surfaces at theta [N, 3], by NumPy."""
    apart = s[None] - theta[:, None, :2]
    sin, cos = np.sin(-theta[:, 2])[:, None], np.cos(-theta[:, 2])[:, None]
    x, y = cos * apart[..., 0] - sin * apart[..., 1], sin * apart[..., 0] + cos * apart[..., 1]
    distances = []
    for cx, cy, a, hx, hy, r in SHAPES:
        u, v = x + 0.5 - cx, y + 0.5 - cy
        qx = np.abs(np.cos(a) * u + np.sin(a) * v) - (hx - r)
        qy = np.abs(np.cos(a) * v - np.sin(a) * u) - (hy - r)
        inner = np.minimum(np.maximum(qx, qy), 0)
        distances.append(np.hypot(np.maximum(qx, 0), np.maximum(qy, 0)) + inner - r)
    return np.min(distances, 0)


def chance(theta, s, width=0.03):
    """p(1 | s [M, 2], theta [N, 3]) [N, M], by NumPy."""
    logit = (WORLD.radius + width - distance(theta, s)) / width
    return 0.05 + 0.9 / (1 + np.exp(-logit))


def measurements(count=60):
    """Positions [M, 2] and measurements [M] of the true pose."""
    rng = np.random.default_rng(3)
    s = rng.uniform(0.1, 0.9, (count, 2))
    return s, (rng.random(count) < chance(TRUE[None], s)[0]).astype(float)


def felt():
    """The same of a solid ball: 20 contacts at d = r and 40 positions without one."""
    rng = np.random.default_rng(4)
    s = rng.uniform(0.1, 0.9, (20_000, 2))
    d = distance(TRUE[None], s)[0] - WORLD.radius
    s = np.concatenate([s[np.abs(d) < 0.002][:20], s[d > 0.02][:40]])
    order = rng.permutation(60)
    return s[order], (order < 20).astype(float)


def filtered(belief, key, made):
    """The belief after all measurements."""
    s, y = (jnp.asarray(a, jnp.float32) for a in made)
    first, adding = jax.random.split(key)

    def one(state, measured):
        return belief.add(state, *measured), None

    keys = jax.random.split(adding, len(y))
    return jax.lax.scan(one, belief.init(first, SPEC), (s, y, keys))[0]


def posterior(made, trust=1.0, width=0.03):
    """Mean position, circular mean angle, spread of the position: exact, on a grid."""
    side = 0.3 + 0.4 * (np.arange(31) + 0.5) / 31
    angle = -np.pi + 2 * np.pi * (np.arange(72) + 0.5) / 72
    theta = np.stack(np.meshgrid(side, side, angle, indexing="ij"), -1).reshape(-1, 3)
    log_w = np.zeros(len(theta))
    for at, one in zip(*made, strict=True):
        p = chance(theta, at[None], width)[:, 0]
        log_w += trust * np.log(np.where(one == 1, p, 1 - p))
    w = np.exp(log_w - log_w.max())
    w /= w.sum()
    mean = w @ theta[:, :2]
    spread = np.sqrt(w @ ((theta[:, :2] - mean) ** 2).sum(1))
    return mean, np.angle(w @ np.exp(1j * theta[:, 2])), spread


def estimated(belief, made):
    """The reports of filters with two keys."""
    run = jax.jit(jax.vmap(lambda key: belief.report(filtered(belief, key, made))))
    report = run(jax.random.split(jax.random.key(0)))
    return [{name: float(value[i]) for name, value in report.items()} for i in range(2)]


def apart(got, mean, angle):
    """Distance [m] and angle [rad] of a report's mean pose from another."""
    turn = np.angle(np.exp(1j * (got["belief/mean_angle"] - angle)))
    return np.hypot(got["belief/mean_x"] - mean[0], got["belief/mean_y"] - mean[1]), abs(turn)


@pytest.mark.parametrize(("kind", "trust"), [("metropolis", 1.0), ("local", 0.5)])
def test_the_posterior_is_that_of_a_grid(kind, trust) -> None:
    """Two keys; without leaps too, where it has one mode; and with a power of the likelihood."""
    mean, angle, spread = posterior(measurements(), trust)
    for got in estimated(replace(BELIEF, kind=kind, trust=trust), measurements()):
        position, turn = apart(got, mean, angle)
        assert position < 0.01
        assert turn < 0.05
        assert got["belief/spread_position"] == pytest.approx(spread, rel=0.2)
        assert 0 < got["belief/accepted"] < 1
    assert np.hypot(*(mean - TRUE[:2])) < 4 * spread


@pytest.mark.parametrize("kind", ["manifold", "jitter"])
def test_filters_that_are_not_exact_come_close(kind) -> None:
    """Within 3 cm and 0.15 rad of the grid's mean, where contacts are on the outline."""
    narrow = KnownMap(WORLD, width=0.01, low=0.05, high=0.95)
    mean, angle, _ = posterior(felt(), width=0.01)
    for got in estimated(replace(BELIEF, kind=kind, particles=1000, map=narrow), felt()):
        position, turn = apart(got, mean, angle)
        assert position < 0.03
        assert turn < 0.15


@pytest.fixture(scope="module")
def few():
    """A belief of 50 weighted particles after 60 measurements of 1,500."""
    state = jax.jit(lambda: filtered(BELIEF, jax.random.key(5), measurements()))()
    rng = np.random.default_rng(0)
    keep = rng.integers(1500, size=50)
    return replace(BELIEF, particles=50, subset=50), state._replace(
        theta=state.theta[keep] + jnp.asarray(0.1 * rng.normal(size=(50, 3)), jnp.float32),
        log_w=jnp.zeros(50),
        log_like=state.log_like[keep],
    )


def test_information_follows_its_formulas(few) -> None:
    """Slopes by finite differences of the NumPy map; entropies by enumeration of both outcomes."""
    belief, state = few
    theta, s = np.asarray(state.theta, np.float64), np.array([0.42, 0.63])
    at, h = jnp.asarray(s, jnp.float32), 1e-4
    p = chance(theta, s[None])[:, 0]
    steps = h * np.eye(3)
    g = [(chance(theta + d, s[None]) - chance(theta - d, s[None]))[:, 0] / (2 * h) for d in steps]
    g = np.stack(g, -1) / [1, 1, 0.3] / np.sqrt(p * (1 - p))[:, None]
    got = jax.jit(belief.information)(state, at)
    assert float(got) == pytest.approx((g**2).sum(1).mean(), rel=1e-3)
    det = np.linalg.det(np.mean(g[:, :, None] * g[:, None], 0))
    got = jax.jit(replace(belief, measure="det").information)(state, at)
    assert float(got) == pytest.approx(det, rel=1e-2)

    def entropy(w):
        return -np.sum(w * np.log(w))

    gain = np.log(50)
    for outcome in (p, 1 - p):
        chance_of_it = outcome.mean()
        gain -= chance_of_it * entropy(outcome / outcome.sum())
    assert float(jax.jit(belief.gain)(state, at)) == pytest.approx(gain, rel=1e-3)
    got = jax.jit(replace(belief, measure="mutual").information)(state, at)
    assert float(got) == pytest.approx(gain, rel=1e-3)


@pytest.mark.parametrize("trust", [1.0, 0.5])
def test_the_gain_along_a_way_is_that_of_its_expected_measurements(few, trust) -> None:
    """Entropy of 50 equal weights minus that of Bayes' rule, one measurement after the other."""
    belief, state = few
    path = np.linspace([0.1, 0.3], [0.45, 0.6], 6)
    p = chance(np.asarray(state.theta, np.float64), path)
    w = np.full(50, 1 / 50)
    for each in p.T:
        w *= (each if each.mean() > 0.5 else 1 - each) ** trust
        w /= w.sum()
    assert {bool(each.mean() > 0.5) for each in p.T} == {True, False}
    got = jax.jit(replace(belief, trust=trust).gain_along)(state, jnp.asarray(path, jnp.float32))
    assert float(got) == pytest.approx(np.log(50) + np.sum(w * np.log(w)), rel=1e-3)


def test_one_or_two_particles_have_a_determinant_of_zero(few) -> None:
    """The information of one measurement has rank one; one pose has no entropy to lose."""
    belief, state = few
    at = jnp.array([0.42, 0.63])
    for count in (1, 2):
        same = state._replace(theta=jnp.tile(state.theta[:count], (50 // count, 1)))
        det = jax.jit(replace(belief, measure="det").information)(same, at)
        assert float(det) < 1e-6 * float(jax.jit(belief.information)(same, at)) ** 3
    one = state._replace(theta=jnp.tile(state.theta[:1], (50, 1)))
    assert float(jax.jit(belief.gain)(one, at)) < 1e-6


def test_a_full_memory_takes_no_more_measurements() -> None:
    belief = replace(BELIEF, particles=20, capacity=2)
    state = jax.jit(partial(belief.init, spec=SPEC))(jax.random.key(0))
    add = jax.jit(belief.add)
    for i in range(4):
        before = state
        state = add(state, jnp.full(2, 0.3), jnp.float32(i % 2), jax.random.key(i))
    assert float(belief.report(state)["belief/full"]) == 1
    for old, new in zip(before[1:7], state[1:7], strict=True):
        np.testing.assert_array_equal(old, new)
