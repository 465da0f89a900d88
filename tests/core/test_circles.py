"""Circles are found in data, and kept."""

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.core import circles
from hybrid_rl.core.circles import Circles


def observed(*batches: jax.Array, times: int = circles.LEAST) -> Circles:
    """What batches [B, n] show that come again and again, `times` in all."""
    each = jnp.stack(batches)[jnp.arange(times) % len(batches)]
    begun = circles.init(each.shape[-1])
    return jax.lax.scan(lambda shown, obs: (circles.update(shown, obs), None), begun, each)[0]


def entries(key: jax.Array, angle: float, count: int = 400) -> jax.Array:
    """[count, 6]: sin a, noise, cos a, 0.13 cos b, a constant, 0.13 sin b; |a|, |b| < angle."""
    for_angles, for_noise = jax.random.split(key)
    a, b = jax.random.uniform(for_angles, (2, count), minval=-angle, maxval=angle)
    noise, one = jax.random.normal(for_noise, (count,)), jnp.ones(count)
    sines = (jnp.sin(a), noise, jnp.cos(a), 0.13 * jnp.cos(b), one, 0.13 * jnp.sin(b))
    return jnp.stack(sines, 1)


def test_pairs_are_found_wherever_they_are() -> None:
    """With their radii; noise and what is constant belong to no circle."""
    keys = jax.random.split(jax.random.key(0), 5)
    shown = observed(*(entries(key, 3.0) for key in keys))
    np.testing.assert_allclose(shown.radius, [1, 0, 1, 0.13, 0, 0.13], rtol=1e-4)
    assert shown.partner[jnp.array([0, 2, 3, 5])].tolist() == [2, 0, 5, 3]


def test_a_pole_that_falls_once_and_then_balances_stays_on_its_circle() -> None:
    """Nine batches of ten have angles below 0.01."""
    keys = jax.random.split(jax.random.key(1), 10)
    shown = observed(entries(keys[0], 0.6), *(entries(key, 0.01) for key in keys[1:]))
    np.testing.assert_allclose(shown.radius, [1, 0, 1, 0.13, 0, 0.13], rtol=1e-4)


def test_a_few_batches_and_noisy_sensors_show_no_circle() -> None:
    """Of a few states many sums are constant by chance."""
    key, for_noise = jax.random.split(jax.random.key(2))
    obs = entries(key, 3.0)
    noisy = obs + 0.01 * jax.random.normal(for_noise, obs.shape)
    assert (observed(obs).radius > 0).any()
    for shown in (observed(obs, times=circles.LEAST - 1), observed(noisy)):
        assert (shown.radius == 0).all()


def test_directions_and_all_other_entries_stay() -> None:
    """A pair goes straight to its circle; elsewhere not a bit changes."""
    shown, x = observed(entries(jax.random.key(3), 3.0)), jnp.array([0.6, 7.0, 0.9, 0.2, 1.1, -0.1])
    onto = np.asarray(circles.onto(shown, x))
    np.testing.assert_allclose(onto[[0, 2]], np.array([0.6, 0.9]) / np.hypot(0.6, 0.9), rtol=1e-4)
    np.testing.assert_allclose(onto[[3, 5]], 0.13 * np.array([2, -1]) / np.hypot(2, 1), rtol=1e-4)
    assert (onto[[1, 4]] == x[jnp.array([1, 4])]).all()
    slopes = jax.jacfwd(lambda x: circles.onto(shown, x))(jnp.zeros(6))
    assert bool(jnp.isfinite(slopes).all())
