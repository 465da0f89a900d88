"""The scale of returns: what rewards are divided by, so that a bounded critic can hold them.

    G' = r + gamma G,    scale = max(std of all G', max |G'| / bound)

G is the discounted sum of past rewards in each environment and starts at 0 in each episode.
`params.scale` is the scale [], 1 before the first reward. Source: SimbaV2 (Lee et al. 2025) and
FlashSAC (Kim et al. 2026).
"""

from typing import Any, ClassVar

import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.fields import Count, Discount, Positive, part
from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class ScaleState:
    """What the decisions so far tell about returns."""

    so_far: Array  # [E] gamma G of the running episodes
    stats: statistics.Running  # of all G, size 1
    largest: Array  # [] |G|


@part
class ReturnScale:
    """The running scale of discounted returns."""

    discount: Discount = 0.99
    bound: Positive = 5.0  # of scaled returns
    num_envs: Count = 1

    data: ClassVar[str] = "latest"
    owns: ClassVar[tuple[str, ...]] = ("scale",)
    every: ClassVar[int] = 1

    def init(self, key: Array, spec: Spec) -> ScaleState:
        """No rewards yet. The key is not used."""
        return ScaleState(jnp.zeros(self.num_envs), statistics.init(1), jnp.zeros(()))

    def params(self, state: ScaleState) -> dict[str, Any]:
        """The scale []."""
        scale = jnp.maximum(state.stats.std[0], state.largest / self.bound)
        return {"scale": jnp.where((state.largest > 0) & (scale > 0), scale, 1.0)}

    def update(
        self, state: ScaleState, params: Params, batch: Batch, key: Array
    ) -> tuple[ScaleState, dict[str, Array]]:
        """The state after the rewards of one round [E]; the key is not used."""
        now = batch.reward + state.so_far
        ended = jnp.maximum(batch.terminated, batch.truncated)
        state = ScaleState(
            self.discount * (1 - ended) * now,
            statistics.update(state.stats, now[:, None], rate=0.0),
            jnp.maximum(state.largest, jnp.abs(now).max()),
        )
        return state, {"return_scale/scale": self.params(state)["scale"]}
