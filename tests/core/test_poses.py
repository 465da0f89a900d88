"""Moves between poses leave distributions invariant."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.core import poses

OUTLINE = jnp.asarray(np.random.default_rng(0).uniform(0.3, 0.7, (40, 2)), jnp.float32)
FRAME = poses.Frame(jnp.zeros(2), jnp.array([1.0, 2.0]), jnp.array([0.5, 0.5]), OUTLINE)
KINDS = {"turn": (1.0, 0.0, 0.0), "walk": (0.0, 1.0, 0.0), "leap": (0.0, 0.0, 1.0)}
CONTACT = jnp.array([0.4, 0.9])


@jax.jit
def move(theta, known, chances, key):
    return poses.move(FRAME, theta, CONTACT, known, chances, key)


def test_positions_go_to_the_map_and_back() -> None:
    """As complex numbers: turning is a product."""
    theta, s = np.array([0.3, -0.2, 2.0]), np.array([0.7, 0.1])
    got = poses.to_map(jnp.asarray(theta), jnp.asarray(s), FRAME.middle)
    z = (complex(*s) - complex(*theta[:2])) * np.exp(-2j) + complex(0.5, 0.5)
    np.testing.assert_allclose(got, [z.real, z.imag], rtol=1e-5)
    np.testing.assert_allclose(poses.from_map(jnp.asarray(theta), got, FRAME.middle), s, rtol=1e-5)


@jax.jit
@partial(jax.vmap, in_axes=(0, None))
def chain(key, chances):
    """A pose after ten moves, and how many were accepted."""

    def one(theta, key):
        proposing, accepting = jax.random.split(key)
        new, ratio = poses.move(FRAME, theta, CONTACT, jnp.array(True), chances, proposing)
        good = (jnp.log(jax.random.uniform(accepting)) < ratio) & poses.inside(FRAME, new)
        return jnp.where(good, new, theta), good

    first, moving = jax.random.split(key)
    return jax.lax.scan(one, poses.draw(FRAME, first), jax.random.split(moving, 10))


@pytest.mark.parametrize("kind", KINDS)
def test_moves_keep_a_uniform_distribution(kind) -> None:
    """4,000 poses from the prior, ten moves each: every tenth of each entry stays a tenth."""
    theta, good = chain(jax.random.split(jax.random.key(1), 4000), jnp.array(KINDS[kind]))
    assert good.mean() > 0.01
    unit = (np.asarray(theta) - [0, 0, -np.pi]) / [1, 2, 2 * np.pi]
    for entry in unit.T:
        counts = np.histogram(entry, 10, (0, 1))[0]
        assert counts.sum() == 4000
        np.testing.assert_allclose(counts, 400, atol=4 * np.sqrt(400 * 0.9))  # four deviations


def test_a_turn_keeps_the_contact() -> None:
    """The position in the map's frame does not change."""
    theta = jnp.array([0.3, 1.2, 0.5])
    seen = jax.jit(lambda theta: poses.to_map(theta, CONTACT, FRAME.middle))
    for i in range(5):
        new, ratio = move(theta, True, KINDS["turn"], jax.random.key(i))
        np.testing.assert_allclose(seen(new), seen(theta), atol=1e-5)
        assert float(ratio) == 0
        assert float(jnp.abs(new - theta).max()) > 1e-3


def test_leaps_have_the_density_that_is_reported() -> None:
    """Shares of 40,000 leaps in balls around some of them."""

    @jax.jit
    @jax.vmap
    def leap(key):
        return move(jnp.array([0.5, 0.5, 0.0]), True, KINDS["leap"], key)[0]

    drawn = np.asarray(leap(jax.random.split(jax.random.key(2), 40_000)))
    radius = np.array([0.02, 0.02, 0.2])
    grid = np.stack(np.meshgrid(*[np.linspace(-1, 1, 9)] * 3), -1).reshape(-1, 3)
    density = jax.jit(jax.vmap(lambda theta: poses.log_leap(FRAME, theta, CONTACT)))
    middles = drawn[:6]
    shares = [(np.abs(drawn - m) < radius).all(1).mean() for m in middles]
    wanted = [
        float(jnp.exp(density(jnp.asarray(m + radius * grid))).mean()) * np.prod(2 * radius)
        for m in middles
    ]
    assert np.sum(shares) > 3e-3
    np.testing.assert_allclose(np.sum(shares), np.sum(wanted), rtol=0.15)


def test_without_a_contact_a_move_is_a_walk() -> None:
    """Whatever the chances."""
    theta = jnp.array([0.3, 1.2, 0.5])
    for i in range(3):
        walk = move(theta, False, KINDS["walk"], jax.random.key(i))
        for chances in (KINDS["leap"], poses.CHANCES):
            got = move(theta, False, chances, jax.random.key(i))
            np.testing.assert_array_equal(got[0], walk[0])
            assert float(got[1]) == 0


def test_each_particle_is_drawn_in_proportion_to_its_weight() -> None:
    """Floor or ceiling of count times weight, and exactly that on average over the shifts."""
    rng = np.random.default_rng(0)
    w = rng.dirichlet(np.ones(20))
    shifts = (np.arange(400) + 0.5) / 400
    drawn = (poses.systematic(jnp.log(w), 50, jnp.float32(shift)) for shift in shifts)
    counts = np.stack([np.bincount(each, minlength=20) for each in drawn])
    assert (counts.sum(1) == 50).all()
    assert (counts >= np.floor(50 * w - 1e-4)).all()
    assert (counts <= np.ceil(50 * w + 1e-4)).all()
    np.testing.assert_allclose(counts.mean(0), 50 * w, atol=0.02)


def test_a_shift_near_one_stays_within_the_particles() -> None:
    """Rounding of the cumulative sum draws no particle of weight 0."""
    drawn = poses.systematic(jnp.log(jnp.array([0.3, 0.7, 0.0])), 7, jnp.float32(0.9999999))
    assert int(drawn.max()) == 1


def test_circular_mean_is_the_argument_of_the_mean_of_unit_numbers() -> None:
    rng = np.random.default_rng(1)
    angle, w = np.pi + 0.3 * rng.normal(size=30), rng.dirichlet(np.ones(30))
    mean = np.sum(w * np.exp(1j * angle))
    got = poses.circular(jnp.asarray(angle), jnp.asarray(w))
    np.testing.assert_allclose(got, [np.angle(mean), np.abs(mean)], rtol=1e-5)
