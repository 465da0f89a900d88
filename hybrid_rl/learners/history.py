"""Copies of the model at regular intervals of a run, for studies; it learns nothing itself.

The last checkpoint then has the models of the whole run. A ring keeps the last `copies` of them.
"""

from typing import Any, ClassVar

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.fields import Count, part
from hybrid_rl.protocols import Model
from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class HistoryState:
    """The copies so far."""

    models: Any  # parameters of the model, leaves [copies, ...]
    count: Array  # [] copies made


@part
class ModelHistory:
    """A copy of the model's parameters before decision 0, `every`, 2 `every`, ..."""

    model: Model
    every: Count = 100  # decisions between two copies
    copies: Count = 10

    data: ClassVar[str] = "latest"
    owns: ClassVar[tuple[str, ...]] = ()

    def init(self, key: Array, spec: Spec) -> HistoryState:
        """No copies. The key is not used."""
        like = jax.eval_shape(lambda: self.model.init(key, spec))
        empty = jax.tree.map(lambda x: jnp.zeros((self.copies, *x.shape), x.dtype), like)
        return HistoryState(empty, jnp.zeros((), jnp.int32))

    def params(self, state: HistoryState) -> dict[str, Any]:
        """No parameters: the copies are for studies."""
        return {}

    def update(
        self, state: HistoryState, params: Params, batch: Batch, key: Array
    ) -> tuple[HistoryState, dict[str, Array]]:
        """One more copy; the batch and the key are not used."""
        slot = state.count % self.copies
        models = jax.tree.map(lambda all_, x: all_.at[slot].set(x), state.models, params.model)
        return HistoryState(models, state.count + 1), {}
