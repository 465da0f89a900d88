"""Metrics of one decision in every environment of an agent."""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import EnvState


def outcome(action: Array, now: EnvState) -> dict[str, Array]:
    """What a decision with action [E, m] led to: `world/...` [], and `episode/...` [E] so far."""
    world = {**now.metrics, "reward": now.reward, "obs": now.obs, "action": action}
    return {
        **masked_mean({f"world/{name}": value for name, value in world.items()}, True),
        "episode/done": now.done,
        "episode/return": now.clock.total,
        "episode/length": now.clock.decision,
    }


def masked_mean(
    metrics: dict[str, Array], when: Array | bool, sparse: bool = False
) -> dict[str, Array]:
    """The means [] of metrics: NaN unless `when`, infinite if a value is not finite.

    sparse: NaN marks values that do not apply, which the mean omits.
    """

    def mean(value: Array) -> Array:
        finite = jnp.isfinite(value)
        if not sparse:
            return jnp.where(finite.all(), value.mean(), jnp.inf)
        average = jnp.where(finite, value, 0).sum() / finite.sum()
        return jnp.where(jnp.isinf(value).any(), jnp.inf, average)

    return {name: jnp.where(when, mean(value), jnp.nan) for name, value in metrics.items()}
