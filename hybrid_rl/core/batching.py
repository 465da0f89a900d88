"""Trees of arrays with a leading axis of members: repeat, join, choose, change, pack."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.custom_batching import custom_vmap

Change = Callable[[Any, Any], Any]


def repeat(tree: Any, *sizes: int) -> Any:
    """A tree [...] once for each member: [*sizes, ...]."""
    return jax.tree.map(lambda leaf: jnp.broadcast_to(leaf, (*sizes, *jnp.shape(leaf))), tree)


def prepend(first: Any, rest: Any) -> Any:
    """The tree [T+1, ...] of `first` [...] and what follows it, `rest` [T, ...]."""
    return jax.tree.map(lambda a, b: jnp.concatenate([a[None], b]), first, rest)


def join(*trees: Any) -> Any:
    """The members of all trees [n_i, ...] as one tree [sum n_i, ...]; of one, no copy."""
    return jax.tree.map(lambda *x: jnp.concatenate(x), *trees) if trees[1:] else trees[0]


def batch_all(size: int, batched: Any, arguments: Any) -> Any:
    """The arguments of a `custom_vmap` rule, all with the leading axis: [size, ...].

    batched: a tree of whether they have it.
    """
    return jax.tree.map(lambda has, x: x if has else repeat(x, size), batched, arguments)


def where(flags: Array, a: Any, b: Any) -> Any:
    """The members of a tree a [..., *x] where flags [...] are true, else those of b [..., *x]."""

    def one(a: Array, b: Array) -> Array:
        return jnp.where(flags.reshape(flags.shape + (1,) * (b.ndim - flags.ndim)), a, b)

    return jax.tree.map(one, a, b)


def when_any(needs: Callable[[Any], Array], change: Change) -> Change:
    """`change(state, argument) -> state`, skipped if `needs(state)` is false for all members.

    `lax.cond` under `vmap` computes both branches. Here all members take one branch, under any
    number of `vmap`s, so `change` itself must leave members unchanged that do not need it.
    """

    @custom_vmap
    def branch(state: Any, argument: Any) -> Any:
        any_member = jnp.any(needs(state))
        return jax.lax.cond(any_member, change, lambda state, _: state, state, argument)

    @branch.def_vmap
    def _(size: int, batched: Any, state: Any, argument: Any) -> tuple[Any, Any]:
        state, argument = batch_all(size, batched, [state, argument])
        after = when_any(jax.vmap(needs), jax.vmap(change))(state, argument)
        return after, jax.tree.map(lambda _: True, after)

    return branch


def _bits(leaf: Any) -> Array:
    """Numbers of 32 bits, bool or keys as uint32."""
    leaf = jnp.asarray(leaf)
    if jnp.issubdtype(leaf.dtype, jax.dtypes.prng_key):
        return jax.random.key_data(leaf)
    leaf = leaf.astype(jnp.uint32) if leaf.dtype == bool else leaf
    return jax.lax.bitcast_convert_type(leaf, jnp.uint32)


def words(tree: Any) -> Array:
    """The leaves of 32 bits, bool or keys, one after the other, as uint32 [w]."""
    return jnp.concatenate([_bits(leaf).ravel() for leaf in jax.tree.leaves(tree)])


def of_words(given: Array, like: Any) -> Any:
    """The inverse of `words`, for a tree of the shapes and types of `like`."""
    like, shapes = jax.eval_shape(lambda tree: (tree, jax.tree.map(_bits, tree)), like)
    ends = np.cumsum([bits.size for bits in jax.tree.leaves(shapes)])[:-1]
    parts = jax.tree.unflatten(jax.tree.structure(like), jnp.split(given, ends))

    def one(leaf: Any, bits: Any, part: Array) -> Array:
        part = part.reshape(bits.shape)
        if jnp.issubdtype(leaf.dtype, jax.dtypes.prng_key):
            return jax.random.wrap_key_data(part)
        same = leaf.dtype != bool
        return jax.lax.bitcast_convert_type(part, leaf.dtype) if same else part != 0

    return jax.tree.map(one, like, shapes, parts)
