"""What each member of an ensemble predicts; a model that is none counts as one member."""

from typing import Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.batching import repeat
from hybrid_rl.protocols import Model


def predict_members(model: Model, params: Any, x: Array, u: Array) -> tuple[Array, Array, Array]:
    """The next state [n], the disagreement [n] or [], and every member's next state [members, n].

    params: of the model.
    """
    each: Any = getattr(model, "predictions", None)
    if each is not None:
        return each(params, x, u)
    after = model.step(params, x, u)
    return after, jnp.zeros(()), repeat(after, 1)
