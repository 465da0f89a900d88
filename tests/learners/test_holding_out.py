"""Held-out decisions against a hash in plain Python, and by their frequencies."""

import struct

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.learners.model import flags, only, without
from hybrid_rl.types import Batch

FULL = 2**32


def mix(h: int) -> int:
    """MurmurHash3's finaliser, from its definition."""
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
        h ^= h >> shift
        h = h * factor % FULL
    return h ^ h >> 16


def test_the_hash_is_the_one_of_the_definition() -> None:
    """For every decision, with Python's integers."""
    rng = np.random.default_rng(0)
    obs, action = rng.normal(size=(200, 3)), rng.uniform(-1, 1, (200, 2))
    obs, action = (x.astype(np.float32) for x in (obs, action))
    want = []
    for row in np.concatenate([obs, action], 1):
        bits = struct.unpack("<5I", row.tobytes())
        h = mix(sum(mix((b + i * 0x9E3779B9) % FULL) for i, b in enumerate(bits)) % FULL)
        want.append(h < 0.3 * FULL)
    got = flags(jnp.asarray(obs), jnp.asarray(action), 0.3)
    np.testing.assert_array_equal(got, want)


@pytest.mark.parametrize("step", [1.0, 0.01, 2.0**-20])
def test_the_share_is_held_out_of_any_grid(step: float) -> None:
    """Of 20,000 decisions on a grid, within four standard deviations of the binomial law."""
    grid = step * jnp.arange(20_000.0)
    for share in (0.05, 0.5):
        held = flags(grid[:, None], jnp.zeros((20_000, 1)), share)
        assert abs(held.mean() - share) < 4 * np.sqrt(share * (1 - share) / 20_000)


def test_rows_are_replaced_and_selected() -> None:
    """Each row that is held out becomes the one before it; the others stay."""
    rows = jnp.arange(6.0)
    batch = Batch(rows[:, None], rows[:, None], rows, rows, rows, rows[:, None])
    held = jnp.array([True, False, True, True, False, True])
    assert without(batch, held).reward.tolist() == [4, 1, 1, 1, 4, 4]
    chosen, real = jax.jit(only, static_argnums=2)(batch, held, 5)
    assert chosen.reward[real].tolist() == [0, 2, 3, 5]
    assert only(batch, held, 2)[0].reward.tolist() == [0, 2]
