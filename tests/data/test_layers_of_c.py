"""The literals of an exported C header."""

import numpy as np

from hybrid_rl.data import layers


def test_lines_are_as_short_as_c99_asks():
    """Section 5.2.4.1: a compiler must take 4,095 characters; a float32 is read back exactly."""
    values = np.random.default_rng(0).normal(size=1000).astype(np.float32)
    text = layers._floats(values)
    assert max(map(len, text.splitlines())) <= 4095
    read = [np.float32(each.strip().removesuffix("f")) for each in text.split(",")]
    np.testing.assert_array_equal(read, values)
