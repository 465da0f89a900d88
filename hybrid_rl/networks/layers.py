"""Flax's dense layer and layer norm for a GPU: bias, scale and shift learn by `core.row_sums`."""

from typing import Any

import jax.numpy as jnp
from flax import linen as nn
from flax.linen.dtypes import promote_dtype
from jax import Array

from hybrid_rl.core.row_sums import repeated

FEW = 64  # rows, below which a sum is a sum


class Dense(nn.Module):
    """x W + b."""

    features: int
    kernel_init: nn.initializers.Initializer
    dtype: Any = None  # of products and results; None: that of x and W
    precision: Any = None  # of products of float32 matrices

    @nn.compact
    def __call__(self, x: Array) -> Array:
        """y [..., features] for x [..., d]."""
        kernel = self.param("kernel", self.kernel_init, (x.shape[-1], self.features))
        bias = self.param("bias", nn.initializers.zeros, (self.features,))
        x, kernel, bias = promote_dtype(x, kernel, bias, dtype=self.dtype)
        y = jnp.matmul(x, kernel, precision=self.precision)
        return y + _along(bias, y, self.precision)


class LayerNorm(nn.Module):
    """(x - mean(x)) / std(x) of each row, times a scale, plus a shift."""

    use_scale: bool = True
    dtype: Any = None  # of results; None: that of x
    precision: Any = None  # of the sums of the gradients of float32 rows

    @nn.compact
    def __call__(self, x: Array) -> Array:
        """y [..., d] for x [..., d]."""
        y = nn.LayerNorm(use_scale=False, use_bias=False, dtype=jnp.float32)(x)
        if self.use_scale:
            scale = self.param("scale", nn.initializers.ones, x.shape[-1:])
            y = y * _along(scale, y, self.precision)
        shift = self.param("bias", nn.initializers.zeros, x.shape[-1:])
        return (y + _along(shift, y, self.precision)).astype(self.dtype or x.dtype)


def _along(v: Array, x: Array, precision: Any) -> Array:
    """v [d] in each row of x [..., d]."""
    rows = x.size // x.shape[-1]
    if rows < FEW:
        return jnp.broadcast_to(v, x.shape)
    return repeated(v, rows, precision).reshape(x.shape)
