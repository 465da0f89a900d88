"""A vector in each row of a batch, whose gradient is a product of matrices.

The gradient of a bias or of a layer norm's scale is a sum over rows. On a GPU XLA computes sums of
columns with few threads, each of which walks down many rows; a product with a matrix of zeros and
ones runs on the units for products.
"""

from typing import Any

import jax.numpy as jnp
from jax import Array
from jax.core import ShapedArray
from jax.extend.core import Primitive
from jax.interpreters import ad, batching, mlir
from jax.lax import Precision

PARTS = 16  # sums that add up to the sum over all rows: the least height of a product on a GPU

_repeated = Primitive("repeated")


def summed(x: Array, precision: Precision | None) -> Array:
    """The sum [..., d] of the rows of x [..., rows, d], in float32 or wider numbers."""
    wide = jnp.promote_types(x.dtype, jnp.float32)
    parts = jnp.arange(x.shape[-2])[None] % PARTS == jnp.arange(PARTS)[:, None]
    each = jnp.matmul(parts.astype(x.dtype), x, precision=precision, preferred_element_type=wide)
    return each.sum(-2)


def repeated(v: Array, rows: int, precision: Precision | None) -> Array:
    """v [..., d] in each of `rows` rows [..., rows, d]; precision: of its gradient."""
    return _repeated.bind(v, rows=rows, precision=precision)


def _shown(v: Array, *, rows: int, **numbers: Any) -> Array:
    return jnp.broadcast_to(v[..., None, :], (*v.shape[:-1], rows, v.shape[-1]))


def _shape(v: Any, *, rows: int, **numbers: Any) -> ShapedArray:
    return ShapedArray((*v.shape[:-1], rows, v.shape[-1]), v.dtype)


def _gradient(g: Any, v: Any, *, precision: Precision | None, **size: Any) -> list[Any]:
    zero = isinstance(g, ad.Zero)
    return [ad.Zero(v.aval) if zero else summed(g, precision).astype(g.dtype)]


def _mapped(args: Any, axes: Any, **options: Any) -> tuple[Array, int]:
    return repeated(jnp.moveaxis(args[0], axes[0], 0), **options), 0


_repeated.def_impl(_shown)
_repeated.def_abstract_eval(_shape)
ad.deflinear2(_repeated, _gradient)
batching.primitive_batchers[_repeated] = _mapped
mlir.register_lowering(_repeated, mlir.lower_fun(_shown, multiple_results=False))
