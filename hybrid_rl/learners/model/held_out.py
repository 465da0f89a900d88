"""Decisions held out of training, chosen by a hash of what was observed and done.

    held out:  mix(sum_i mix(b_i + i g)) < share 2^32

b_i are the bits of the entries of (o, u), g = 2^32 / 1.618, and mix is the last step of MurmurHash3
(Appleby 2011). A decision is held out or not for a whole run and after a resume, in any
order of the memory, and nothing is stored.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import Batch

GOLDEN = 0x9E3779B9  # 2^32 / 1.618


def flags(obs: Array, action: Array, share: float) -> Array:
    """Which decisions are held out [B], for observations [B, o] and actions [B, m]."""
    entries = jnp.concatenate([obs, action], 1).astype(jnp.float32)
    bits = jax.lax.bitcast_convert_type(entries, jnp.uint32)
    offsets = jnp.arange(bits.shape[1], dtype=jnp.uint32) * jnp.uint32(GOLDEN)
    mixed = _mix(_mix(bits + offsets[None]).sum(1, dtype=jnp.uint32))
    return mixed < jnp.uint32(round(share * (2**32 - 1)))


def without(batch: Batch, held: Array) -> Batch:
    """`batch` with each row that is held out replaced by the last row before it that is not.

    Rows before the first one that is not held out become the last one that is not. If all are
    held out, which happens with probability share^B, the last row is repeated.
    """
    index = jnp.arange(len(held))
    kept = jax.lax.cummax(jnp.where(held, -1, index))
    kept = jnp.where(kept < 0, kept[-1], kept)
    return jax.tree.map(lambda x: x[kept], batch)


def only(batch: Batch, held: Array, count: int) -> tuple[Batch, Array]:
    """The first `count` rows held out, and which of them are [count]; the others are row 0."""
    index = jnp.flatnonzero(held, size=count, fill_value=0)
    return jax.tree.map(lambda x: x[index], batch), jnp.arange(count) < held.sum()


def _mix(h: Array) -> Array:
    """MurmurHash3's finaliser of uint32 [...]."""
    h = (h ^ (h >> 16)) * jnp.uint32(0x85EBCA6B)
    h = (h ^ (h >> 13)) * jnp.uint32(0xC2B2AE35)
    return h ^ (h >> 16)
