"""Multilayer perceptrons as pure functions: `init(key) -> params`, `apply(params, x) -> y`.

y = W_L a(... a(W_1 x + b_1) ...) + b_L, with W ~ U(-1, 1) / sqrt(width of x) and b = 0 at first.
These weights are PyTorch's default, so soft actor-critic starts as Stable-Baselines3's does; they
have a third of the variance of LeCun's. `precision` says in which numbers they compute.
"""

from collections.abc import Sequence
from typing import Annotated, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from flax import linen as nn
from jax import Array
from scipy.linalg import block_diag

from hybrid_rl.core import statistics
from hybrid_rl.fields import Count, Must
from hybrid_rl.networks import precision

ACTIVATIONS = {"relu": nn.relu, "sin": jnp.sin, "silu": nn.silu, "tanh": jnp.tanh, "elu": nn.elu}
Widths = tuple[Count, ...]  # types of a part's fields
Activation = Annotated[str, Must(lambda a: a in ACTIVATIONS, f"be one of {', '.join(ACTIVATIONS)}")]
SPREAD = nn.initializers.variance_scaling(1 / 3, "fan_in", "uniform")


class MLP(nn.Module):
    """A multilayer perceptron: [..., d] -> [..., out]."""

    hidden: Sequence[int]
    out: int
    activation: str = "relu"
    layer_norm: bool = False  # of every hidden layer
    zero: bool = False  # the last layer starts at zero
    init = jax.jit(nn.Module.init, static_argnums=0)  # equal networks are traced one time

    @nn.compact
    def __call__(self, x: Array) -> Array:
        """The outputs y [..., out] for x [..., d]."""
        kind = jnp.bfloat16 if precision.current() == "bf16" else None  # None: that of weights
        of_products = precision.of_products()
        for width in self.hidden:
            x = nn.Dense(width, kernel_init=SPREAD, dtype=kind, precision=of_products)(x)
            if self.layer_norm:
                x = nn.LayerNorm(dtype=kind)(x)
            x = ACTIVATIONS[self.activation](x)
        last = nn.initializers.zeros if self.zero else SPREAD
        return nn.Dense(self.out, kernel_init=last, precision=of_products)(x)


class Perceptron(NamedTuple):
    """u = middle + half squash(W_L a(... a(W_1 (x - mean) / scale + b_1) ...) + b_L) as arrays."""

    mean: np.ndarray  # [n]
    scale: np.ndarray  # [n]
    weights: tuple[np.ndarray, ...]  # W' [inputs, outputs] of each layer
    biases: tuple[np.ndarray, ...]  # [outputs] of each layer
    activation: str
    squash: str  # tanh or clip (to [-1, 1])
    span: tuple[np.ndarray, np.ndarray] | None = None  # middle [m], half [m]; None: 0 and 1


def perceptron(
    params: Any, state: statistics.Running | None, n: int, m: int, activation: str, squash: str
) -> Perceptron:
    """The MLP that owns `params` {"Dense_0": ..., ...}, of n inputs and the first m outputs.

    state: statistics that normalise the inputs; None: they are taken as they are.
    """
    layers = [params[f"Dense_{i}"] for i in range(len(params))]
    weights, biases = ([np.asarray(one[name]) for one in layers] for name in ("kernel", "bias"))
    weights[-1], biases[-1] = weights[-1][:, :m], biases[-1][:m]
    mean, scale = np.zeros(n, np.float32), np.ones(n, np.float32)
    if state is not None:
        mean, scale = np.asarray(state.mean), np.asarray(state.scale)
    return Perceptron(mean, scale, tuple(weights), tuple(biases), activation, squash)


def side_by_side(each: Sequence[Perceptron]) -> Perceptron:
    """The mean of the outputs before squashing of networks with the same inputs, as one network.

    Its hidden layers hold the units of all of them, its weights are block diagonal.
    """
    first, last = each[0], len(each[0].weights) - 1
    weights, biases = [], []
    for i in range(last + 1):
        kernels, bias = [one.weights[i] for one in each], [one.biases[i] for one in each]
        if i == last:
            stacked = np.concatenate(kernels) if last else np.sum(kernels, 0)
            weights.append(stacked / len(each))
            biases.append(np.mean(bias, 0))
        else:
            weights.append(block_diag(*kernels) if i else np.concatenate(kernels, axis=1))
            biases.append(np.concatenate(bias))
    return first._replace(weights=tuple(weights), biases=tuple(biases))


def outputs(params: Any) -> int:
    """Number of outputs of the MLP that owns `params`."""
    layers = params["params"]
    return layers[f"Dense_{len(layers) - 1}"]["bias"].shape[-1]


def apply(net: nn.Module, params: Any, x: Array) -> Any:
    """Outputs [..., out] of a network at x [..., in]."""
    return net.apply(params, x)


def ensemble_init(net: nn.Module, key: Array, members: int, x: Array) -> Any:
    """Parameters of `members` independent copies of `net`, stacked on axis 0; x [d] gives sizes."""
    return jax.vmap(lambda k: net.init(k, x))(jax.random.split(key, members))


def ensemble_apply(net: nn.Module, params: Any, x: Array) -> Array:
    """Outputs [members, ..., out] of all copies at the same x [..., d].

    x is repeated for each copy: a shared x would give a first layer whose result must be
    transposed, a pass over memory that is slow on a GPU with many learners.
    """
    members = len(jax.tree.leaves(params)[0])
    return jax.vmap(net.apply)(params, jnp.broadcast_to(x, (members, *x.shape)))
