"""The matrix products of a program: how many operations they are, and how long they take alone.

A loop of known length counts as often as it runs, of a choice the costlier branch, and a loop of
unknown length once. Products are nearly all operations of networks; what is elementwise is left
out.
"""

from collections import Counter
from collections.abc import Callable
from math import prod
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax.extend.core import ClosedJaxpr, Jaxpr

from hybrid_rl.tools.benchmark.race import Contestant

REPEATS = 20  # of all products in a turn


class Product(NamedTuple):
    """One kind of product: sizes of both factors, and which axes meet."""

    left: tuple[int, ...]
    right: tuple[int, ...]
    axes: Any  # as `jax.lax.dot_general` takes them

    @property
    def operations(self) -> int:
        """Two for each entry of the result and each pair that is summed in it."""
        (summed, _), (batch, _) = self.axes
        shared = prod(self.left[i] for i in (*summed, *batch))
        return 2 * prod(self.left) * prod(self.right) // shared


def products(f: Callable[..., Any], *given: Any) -> Counter[Product]:
    """How often each kind of product is computed in `f(*given)`; f is traced, not run."""
    return _of(jax.make_jaxpr(f)(*given))


def operations(found: Counter[Product]) -> int:
    """Operations of all `found` products."""
    return sum(product.operations * count for product, count in found.items())


def alone(name: str, found: Counter[Product], work: float) -> Contestant:
    """All `found` products one after the other, `work` units, in float32 and nothing else."""
    factors = [(jnp.ones(p.left), jnp.full(p.right, 1e-3)) for p in found]

    def run(factors: Any) -> Any:
        def one(product: Product, count: int, left: jax.Array, right: jax.Array) -> jax.Array:
            def again(_: int, left: jax.Array) -> jax.Array:  # none can be left out or moved
                result = jax.lax.dot_general(left, right, product.axes)
                return left.at[(0,) * left.ndim].set(result[(0,) * result.ndim])

            return jax.lax.fori_loop(0, REPEATS * count, again, left)

        return [one(*item, *pair) for item, pair in zip(found.items(), factors, strict=True)]

    program = jax.jit(run).lower(factors).compile()
    return Contestant(name, lambda: jax.block_until_ready(program(factors)), REPEATS * work)


def _of(program: Any) -> Counter[Product]:
    found: Counter[Product] = Counter()
    for each in getattr(program, "jaxpr", program).eqns:
        if each.primitive.name == "dot_general":
            left, right = (factor.aval.shape for factor in each.invars)
            found[Product(left, right, each.params["dimension_numbers"])] += 1
        parts = jax.tree.leaves(list(each.params.values()), is_leaf=_is_program)
        inner = [_of(part) for part in parts if _is_program(part)]
        if each.primitive.name == "cond":
            inner = [max(inner, key=operations)]
        for part in inner:
            for product, count in part.items():
                found[product] += count * each.params.get("length", 1)
    return found


def _is_program(x: Any) -> bool:
    return isinstance(x, (ClosedJaxpr, Jaxpr))
