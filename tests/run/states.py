"""A state with leaves of every kind, for tests of checkpoints."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np


class State(NamedTuple):
    params: dict
    replay: dict | None
    key: jax.Array


def state_at(step: int) -> State:
    nan = np.array([0x7FC12345, 0xFFC00001], np.uint32).view(np.float32)
    return State(
        params={
            "mlp/~/w": jnp.arange(12, dtype=jnp.float32).reshape(3, 4) + step,
            "list": [jnp.full((5,), -0.0), (jnp.asarray(nan), jnp.bfloat16(1.1))],
            "count": jnp.int32(step),
            "mask": jnp.array([False, False]),
            "rbg": jax.random.key(step, impl="rbg"),
        },
        replay={"obs": jnp.zeros((20, 3)).at[3].set(step), "none": jnp.zeros((0, 4), jnp.uint8)},
        key=jax.random.split(jax.random.key(step), 3),
    )


def bits(state: State) -> list[tuple]:
    def of(leaf):
        key = jnp.issubdtype(leaf.dtype, jax.dtypes.prng_key)
        plain = np.asarray(jax.random.key_data(leaf) if key else leaf)
        return str(leaf.dtype), plain.shape, plain.tobytes()

    return [of(leaf) for leaf in jax.tree.leaves(state)]


def assert_same(result: State, expected: State):
    assert jax.tree.structure(result) == jax.tree.structure(expected)
    assert all(isinstance(leaf, jax.Array) for leaf in jax.tree.leaves(result))
    assert bits(result) == bits(expected)


def largest_file(folder):
    return max(
        (path for path in folder.rglob("*") if path.is_file()), key=lambda p: p.stat().st_size
    )


def flip(folder):
    """Change one byte in the middle of the largest file of a checkpoint; how it is named."""
    path = largest_file(folder / "state")
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    return "SHA-256 differs"
