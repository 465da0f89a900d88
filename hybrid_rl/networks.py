"""Multilayer perceptrons as pure functions: `init(key) -> params`, `apply(params, x) -> y`.

y = W_L a(... a(W_1 x + b_1) ...) + b_L, with W ~ LeCun normal (flax.linen.Dense's default).
"""

from collections.abc import Sequence
from typing import Any

import jax
import jax.numpy as jnp
from flax import linen as nn
from jax import Array

ACTIVATIONS = {
    "relu": nn.relu,
    "sin": jnp.sin,
    "silu": nn.silu,
    "tanh": jnp.tanh,
    "elu": nn.elu,
}


class MLP(nn.Module):
    """A perceptron: [..., d] -> [..., out].

    `output_scale` bounds the uniform initial weights of the last layer; None takes LeCun's.
    """

    hidden: Sequence[int]
    out: int
    activation: str = "relu"
    output_scale: float | None = None

    @nn.compact
    def __call__(self, x: Array) -> Array:
        """Y [..., out] for x [..., d]."""
        for width in self.hidden:
            x = ACTIVATIONS[self.activation](nn.Dense(width)(x))
        if self.output_scale is None:
            return nn.Dense(self.out)(x)
        last = nn.initializers.uniform(2 * self.output_scale)
        return nn.Dense(self.out, kernel_init=lambda *a: last(*a) - self.output_scale)(x)


def check(name: str, hidden: Sequence[int], activation: str) -> None:
    """Raise ValueError where `hidden` or `activation` of the part `name` make no network."""
    if not all(isinstance(width, int) and width > 0 for width in hidden):
        raise ValueError(f"{name}.hidden={list(hidden)}: widths are positive integers")
    if activation not in ACTIVATIONS:
        raise ValueError(
            f"{name}.activation={activation}: unknown; choose one of {', '.join(ACTIVATIONS)}"
        )


def outputs(params: Any) -> int:
    """Number of outputs of the MLP that owns `params`."""
    layers = params["params"]
    return layers[f"Dense_{len(layers) - 1}"]["bias"].shape[-1]


def ensemble_init(net: nn.Module, key: Array, members: int, x: Array) -> Any:
    """Parameters of `members` independent copies of `net`, stacked on axis 0; x [d] gives sizes."""
    return jax.vmap(lambda k: net.init(k, x))(jax.random.split(key, members))


def ensemble_apply(net: nn.Module, params: Any, x: Array) -> Array:
    """Outputs [members, ..., out] of all copies at the same x [..., d]."""
    return jax.vmap(net.apply, in_axes=(0, None))(params, x)
