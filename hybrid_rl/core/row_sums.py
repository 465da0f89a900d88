"""Sums over the rows of a batch as products of matrices; a vector in each row.

The gradient of a bias or of a layer norm's scale is a sum over rows. XLA computes sums of columns
with few threads, each of which walks down many rows; a product with a matrix of zeros and ones runs
on the units for products. `along` is a primitive, since a function that is written for one row is
mapped over a batch later: its rows are known when the gradient is taken.
"""

from math import prod
from typing import Any

import jax.numpy as jnp
from jax import Array
from jax.core import ShapedArray
from jax.extend.core import Primitive
from jax.interpreters import ad, batching, mlir
from jax.lax import Precision

PARTS = 16  # sums that add up to the sum over all rows: the least height of a product on a GPU
FEW = 128  # rows, below which a sum is a sum

_along = Primitive("along")


def summed(x: Array, precision: Precision | None = Precision.HIGHEST) -> Array:
    """The sum [..., d] of the rows of x [..., rows, d], in float32 or wider numbers."""
    wide = jnp.promote_types(x.dtype, jnp.float32)
    if x.shape[-2] < FEW:
        return x.sum(-2, dtype=wide)
    parts = jnp.arange(x.shape[-2])[None] % PARTS == jnp.arange(PARTS)[:, None]
    each = jnp.matmul(parts.astype(x.dtype), x, precision=precision, preferred_element_type=wide)
    return each.sum(-2)


def along(v: Array, x: Array, precision: Precision | None, dtype: Any = None) -> Array:
    """v [d] in each row of x [..., d].

    precision, dtype: of the products that sum the gradients of the rows.
    """
    numbers = {"precision": precision, "dtype": jnp.dtype(dtype or x.dtype)}
    return _along.bind(v, x[..., 0], mapped=0, **numbers)


def _shown(v: Array, rows: Array, *, mapped: int, **numbers: Any) -> Array:
    """v [*mapped, d] in each of the rows [*mapped, ...]."""
    between = (1,) * (rows.ndim - mapped)
    return jnp.broadcast_to(
        v.reshape(*v.shape[:-1], *between, v.shape[-1]), (*rows.shape, v.shape[-1])
    )


def _shape(v: Any, rows: Any, **numbers: Any) -> ShapedArray:
    return ShapedArray((*rows.shape, v.shape[-1]), v.dtype)


def _tangent(change: Array, v: Array, rows: Array, **options: Any) -> Array:
    return _along.bind(change, rows, **options)


def _gradient(
    g: Any, v: Any, rows: Array, *, mapped: int, precision: Precision | None, dtype: Any
) -> tuple[Any, None]:
    if isinstance(g, ad.Zero):
        return ad.Zero(v.aval), None
    outer, inner = rows.shape[:mapped], rows.shape[mapped:]
    flat = g.reshape(*outer, prod(inner), g.shape[-1])
    return summed(flat.astype(dtype), precision).astype(g.dtype), None


def _mapped(args: Any, axes: Any, *, mapped: int, **options: Any) -> tuple[Array, int]:
    """The rule of vmap: another leading axis of both, or, if v has none, further rows."""
    (v, rows), (of_v, of_rows) = args, axes
    if of_v is None:
        rows = jnp.moveaxis(rows, of_rows, mapped)
        return _along.bind(v, rows, mapped=mapped, **options), mapped
    v = jnp.moveaxis(v, of_v, 0)
    if of_rows is None:
        rows = jnp.broadcast_to(rows, (len(v), *rows.shape))
    else:
        rows = jnp.moveaxis(rows, of_rows, 0)
    return _along.bind(v, rows, mapped=mapped + 1, **options), 0


_along.def_impl(_shown)
_along.def_abstract_eval(_shape)
ad.defjvp(_along, _tangent, None)
ad.primitive_transposes[_along] = _gradient
batching.primitive_batchers[_along] = _mapped
mlir.register_lowering(_along, mlir.lower_fun(_shown, multiple_results=False))
