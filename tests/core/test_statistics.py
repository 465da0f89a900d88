"""Running statistics against NumPy's."""

import jax.numpy as jnp
import numpy as np

from hybrid_rl.core import statistics


def test_the_first_batches_have_equal_weights() -> None:
    """After ten batches, mean, standard deviation and magnitude are those of all rows together."""
    rows = np.random.default_rng(0).normal([1.0, -5.0], [2.0, 0.1], size=(10, 64, 2))
    stats = statistics.init(2)
    for batch in rows:
        stats = statistics.update(stats, jnp.float32(batch))
    np.testing.assert_allclose(stats.mean, rows.reshape(-1, 2).mean(0), rtol=1e-4)
    np.testing.assert_allclose(stats.std, rows.reshape(-1, 2).std(0), rtol=1e-3)
    magnitude = np.sqrt((rows.reshape(-1, 2) ** 2).mean(0))
    np.testing.assert_allclose(stats.magnitude, magnitude, rtol=1e-3)


def test_later_batches_are_weighted_by_the_rate() -> None:
    """With rate 1/2 each batch has as much weight as all before it."""
    rows = np.random.default_rng(0).normal(1.0, 2.0, size=(5, 64, 1)) + np.arange(5)[:, None, None]
    stats = statistics.init(1)
    for batch in rows:
        stats = statistics.update(stats, jnp.float32(batch), rate=0.5)
    w = np.repeat(np.array([1, 1, 2, 4, 8]) / 16 / 64, 64)
    mean = w @ rows.reshape(-1)
    np.testing.assert_allclose(stats.mean[0], mean, rtol=1e-5)
    np.testing.assert_allclose(stats.std[0] ** 2, w @ (rows.reshape(-1) - mean) ** 2, rtol=1e-5)


def test_denormalise_is_the_inverse_of_normalise() -> None:
    """Also for entries that never change, which stay finite; without data it changes nothing."""
    batch = jnp.float32([[1.0, 7.0, 0.0], [3.0, 7.0, 0.0]])
    np.testing.assert_array_equal(statistics.normalise(statistics.init(3), batch), batch)
    stats = statistics.update(statistics.init(3), batch)
    for x in batch:
        white = statistics.normalise(stats, x)
        assert jnp.isfinite(white).all()
        np.testing.assert_allclose(statistics.denormalise(stats, white), x, rtol=1e-5)


def test_small_entries_are_normalised_in_their_own_units():
    """A standard deviation of 1e-4 or 1e-7 becomes 1; rounding errors of a large mean do not."""
    rng = np.random.default_rng(0)
    rows = rng.normal([0.0, 0.0, 1000.0], [1e-4, 1e-7, 1e-5], size=(512, 3))
    stats = statistics.update(statistics.init(3), jnp.float32(rows))
    white = statistics.normalise(stats, jnp.float32(rows)).std(0)
    np.testing.assert_allclose(white[:2], 1, rtol=1e-3)
    assert white[2] < 0.2  # float32 holds 1000 to 6e-5: nothing to see there


def test_changes_have_the_floor_of_the_states_they_come_from():
    """An entry that changes only by rounding errors is not normalised to noise of size one."""
    x = np.float32(np.random.default_rng(0).normal(100.0, 1.0, size=(512, 1)))
    errors = jnp.asarray((x + np.float32(1e-6)) - x)
    state = statistics.update(statistics.init(1), jnp.asarray(x))
    change = statistics.update(statistics.init(1), errors, state.magnitude)
    assert float(statistics.normalise(change, errors).std()) < 0.2
