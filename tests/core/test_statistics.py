"""Running statistics against NumPy's."""

import jax.numpy as jnp
import numpy as np

from hybrid_rl.core import statistics


def test_the_first_batches_count_alike() -> None:
    """After ten batches, mean and deviation are those of all rows together."""
    rows = np.random.default_rng(0).normal([1.0, -5.0], [2.0, 0.1], size=(10, 64, 2))
    stats = statistics.init(2)
    for batch in rows:
        stats = statistics.update(stats, jnp.float32(batch))
    np.testing.assert_allclose(stats.mean, rows.reshape(-1, 2).mean(0), rtol=1e-4)
    np.testing.assert_allclose(stats.std, rows.reshape(-1, 2).std(0), rtol=1e-3)


def test_colour_undoes_whiten() -> None:
    """Also where an entry never changes, which stays finite."""
    batch = jnp.float32([[1.0, 7.0], [3.0, 7.0]])
    stats = statistics.update(statistics.init(2), batch)
    for x in batch:
        white = statistics.whiten(stats, x)
        assert jnp.isfinite(white).all()
        np.testing.assert_allclose(statistics.colour(stats, white), x, rtol=1e-5)
