"""Adam with decay of the weights of layers."""

from typing import Any

import jax
import optax


def adamw(learning_rate: Any, weight_decay: float) -> optax.GradientTransformation:
    """AdamW (Loshchilov and Hutter 2019) with decay of "kernel" leaves alone; Adam if it is 0.

    Biases, deviations and running statistics do not decay.
    """
    if not weight_decay:
        return optax.adam(learning_rate)
    return optax.adamw(learning_rate, weight_decay=weight_decay, mask=_matrices)


def _matrices(params: Any) -> Any:
    """Which leaves are matrices of layers."""
    return jax.tree_util.tree_map_with_path(
        lambda path, _: getattr(path[-1], "key", None) == "kernel", params
    )
