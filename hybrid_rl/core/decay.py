"""Decay: of exploration and learning rates along a run, and of the weights of layers."""

from functools import partial
from typing import Any

import optax
from jax import Array
from jax.tree_util import tree_map_with_path

from hybrid_rl.protocols import Schedule


def of_run(rate: float, decisions: Array | None) -> Array | float:
    """rate^k [] after k `decisions` [] of the run.

    Where they are not counted, after training, it is 0; or 1 if the rate is 1.
    """
    if rate == 1:
        return 1.0
    return 0.0 if decisions is None else rate**decisions


def of_rates(schedule: Schedule | None, decisions: Array | None) -> Array | float:
    """The factor [] of learning rates after so many `decisions` []; 1 without a schedule.

    It is 1, too, where decisions are not counted: before the run and after it.
    """
    return 1.0 if schedule is None or decisions is None else schedule.factor(decisions)


def adamw(learning_rate: Any, weight_decay: float) -> optax.GradientTransformation:
    """AdamW (Loshchilov and Hutter 2019) with decay of "kernel" leaves alone; Adam if it is 0.

    Biases, deviations and running statistics do not decay.
    """
    if not weight_decay:
        return optax.adam(learning_rate)
    is_matrix = partial(tree_map_with_path, lambda path, _: getattr(path[-1], "key", 0) == "kernel")
    return optax.adamw(learning_rate, weight_decay=weight_decay, mask=is_matrix)
