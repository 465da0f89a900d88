"""One branch for a batch: compute a costly change only where some member needs it."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array
from jax.custom_batching import custom_vmap

Change = Callable[[Any, Any], Any]


def when_any(needs: Callable[[Any], Array], change: Change) -> Change:
    """`change(state, argument) -> state`, skipped where `needs(state)` holds for no member.

    `lax.cond` under `vmap` computes both branches. Here there is one branch, however many `vmap`s
    surround the call, so `change` must itself return unchanged the members that need nothing.
    """

    @custom_vmap
    def branch(state: Any, argument: Any) -> Any:
        any_member = jnp.any(needs(state))
        return jax.lax.cond(any_member, change, lambda state, _: state, state, argument)

    @branch.def_vmap
    def _(size: int, batched: Any, state: Any, argument: Any) -> tuple[Any, Any]:
        def lead(is_batched: bool, x: Array) -> Array:
            return x if is_batched else jnp.broadcast_to(x, (size, *x.shape))

        state, argument = jax.tree.map(lead, batched, [state, argument])
        after = when_any(jax.vmap(needs), jax.vmap(change))(state, argument)
        return after, jax.tree.map(lambda _: True, after)

    return branch
