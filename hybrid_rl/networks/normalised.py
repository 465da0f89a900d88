"""Residual networks with unit weights and batch normalisation.

    h_0 = W B(x),   h_{b+1} = h_b + a(B(W a(B(W h_b)))),   y = W rms(h_N) + c,   a(z) = max(z, 0)

B normalises each feature over the batch, or by running statistics, and has a scale and a shift;
the inner layer of a block is four times as wide. `constrained` projects the weights after a
gradient step: each unit's weights have norm 1, scale and shift of d features together sqrt(d). So
the size of the outputs is bounded, and the learning rate acts on directions alone.

Parameters: "weights", which gradients change, and "statistics" of the batches so far.

Source: the networks of FlashSAC (Kim et al. 2026); batch normalisation in actor-critic methods is
that of CrossQ (Bhatt et al. 2024), the projection that of SimbaV2 (Lee et al. 2025). They begin
with orthogonal weights, these with random unit vectors.
"""

from typing import Annotated, Any

import jax
import jax.numpy as jnp
from flax import linen as nn
from jax import Array

from hybrid_rl.fields import Count, Must
from hybrid_rl.networks import precision

EXPANSION = 4  # width of a block's inner layer, in widths of the network
MOMENTUM = 0.99  # of the running statistics
EPSILON = 1e-5  # added to variances
ONE_WIDTH = Must(lambda hidden: len({*hidden}) == 1, "be one width, once for each block")
Blocks = Annotated[tuple[Count, ...], ONE_WIDTH]  # type of a part's field
BEGIN = nn.initializers.normal(1.0)  # `constrained` gives the vectors norm 1


class NormalisedNet(nn.Module):
    """`blocks` residual blocks: [..., d] -> [..., out]."""

    width: int
    blocks: int
    out: int

    @nn.compact
    def __call__(self, x: Array, in_batch: bool) -> Array:
        """The outputs [..., out]; `in_batch` normalises by the statistics of x [B, d] itself."""
        of_products = precision.of_products()

        def normal(x: Array) -> Array:
            return nn.BatchNorm(
                not in_batch, momentum=MOMENTUM, epsilon=EPSILON, use_fast_variance=False
            )(x)

        def linear(x: Array, width: int) -> Array:
            return nn.Dense(width, use_bias=False, kernel_init=BEGIN, precision=of_products)(x)

        x = linear(normal(x), self.width)
        for _ in range(self.blocks):
            inner = nn.relu(normal(linear(x, EXPANSION * self.width)))
            x = x + nn.relu(normal(linear(inner, self.width)))
        head = nn.Dense(self.out, kernel_init=BEGIN, precision=of_products, name="head")
        return head(nn.RMSNorm()(x))


def init(net: NormalisedNet, key: Array, size: int) -> dict[str, Any]:
    """Parameters for inputs [size]. The key is consumed."""
    made: Any = net.init(key, jnp.zeros(size), False)
    return {"weights": constrained(made["params"]), "statistics": made["batch_stats"]}


def apply(net: NormalisedNet, params: dict[str, Any], x: Array) -> Any:
    """Outputs [..., out] at x [..., d], by the running statistics."""
    read = {"params": params["weights"], "batch_stats": params["statistics"]}
    return net.apply(read, x, False)


def apply_in_batch(
    net: NormalisedNet, params: dict[str, Any], x: Array
) -> tuple[Array, dict[str, Any]]:
    """Outputs [B, out] at x [B, d], by the batch's statistics; parameters that include them."""
    read = {"params": params["weights"], "batch_stats": params["statistics"]}
    y, changed = net.apply(read, x, True, mutable=["batch_stats"])
    return y, {**params, "statistics": jax.lax.stop_gradient(changed["batch_stats"])}


def constrained(weights: dict[str, Any]) -> dict[str, Any]:
    """`weights` projected to their norms; leading axes, such as members, are kept."""
    return {name: _projected(layer) for name, layer in weights.items()}


def outputs(params: dict[str, Any]) -> int:
    """Number of outputs of the network that owns `params`."""
    return params["weights"]["head"]["bias"].shape[-1]


def _projected(layer: dict[str, Array]) -> dict[str, Array]:
    if "kernel" in layer:  # [..., inputs, units]
        norm = jnp.linalg.norm(layer["kernel"], axis=-2, keepdims=True)
        return {**layer, "kernel": layer["kernel"] / jnp.maximum(norm, 1e-8)}
    squares = sum((part**2).sum(-1, keepdims=True) for part in layer.values())
    factor = jnp.sqrt(layer["scale"].shape[-1] / jnp.maximum(squares, 1e-8))
    return {name: part * factor for name, part in layer.items()}
