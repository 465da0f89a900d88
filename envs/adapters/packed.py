"""The state of an environment in one array per dtype, for a step that is called from the host.

Each array that enters or leaves a compiled function costs about 2 us, and a step of a small
environment takes less than all arrays of its state do.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import EnvState

Packed = dict[str, Array]  # dtype -> all entries of a state that have it; flags are float32


def outcome(state: EnvState, like: EnvState) -> Array:
    """What the host needs of a state [o + 2 + metrics]: obs, reward, terminated, metrics."""
    numbers = (state.reward, state.terminated, *(state.metrics[name] for name in like.metrics))
    flat = [jnp.asarray(x, jnp.float32).reshape(1) for x in numbers]
    return jnp.concatenate((jnp.asarray(state.obs, jnp.float32), *flat))


def pack(state: EnvState, like: EnvState) -> Packed:
    """`state` with the shapes and dtypes of `like`; float32 begins with `outcome`."""
    parts = {"float32": [outcome(state, like)]}
    for leaf, old in zip(jax.tree.leaves(state), jax.tree.leaves(like), strict=True):
        leaf = jnp.asarray(leaf, old.dtype).reshape(old.size)
        leaf = leaf.astype(jnp.float32) if old.dtype == bool else leaf
        parts.setdefault(str(leaf.dtype), []).append(leaf)
    return {kind: jnp.concatenate(own) for kind, own in parts.items()}


def unpack(packed: Packed, like: EnvState) -> EnvState:
    """The state that `pack` packed."""
    used = {"float32": like.obs.size + 2 + len(like.metrics)}
    leaves = []
    for old in jax.tree.leaves(like):
        kind = "float32" if old.dtype == bool else str(old.dtype)
        begin = used.get(kind, 0)
        used[kind] = end = begin + old.size
        leaf = packed[kind][begin:end].reshape(old.shape)
        leaves.append(leaf.astype(bool) if old.dtype == bool else leaf)
    return jax.tree.unflatten(jax.tree.structure(like), leaves)
