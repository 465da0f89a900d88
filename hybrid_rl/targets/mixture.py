"""p(s) = sum_j w_j N(s; m_j, s_j^2 I): a known target."""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import Params


@dataclass(frozen=True)
class Mixture:
    """A mixture of any number of Gaussians, of any dimension.

    Raises:
        ValueError: for lists of different lengths, or numbers that are not positive.
    """

    means: tuple[tuple[float, ...], ...] = ((0.3, 0.3), (0.7, 0.7))  # [J, v]
    stds: tuple[float, ...] = (0.1, 0.1)  # [J]
    weights: tuple[float, ...] = (0.5, 0.5)  # [J], up to a factor

    def __post_init__(self) -> None:
        """Check the fields."""
        object.__setattr__(self, "means", tuple(tuple(mean) for mean in self.means))
        for name in ("stds", "weights"):
            numbers = tuple(getattr(self, name))
            object.__setattr__(self, name, numbers)
            if len(numbers) != len(self.means) or not all(number > 0 for number in numbers):
                raise ValueError(f"target.{name}={list(numbers)}: one number above 0 for each mean")

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at s [v]; the last entry of a shorter mean is repeated."""
        means = jnp.stack([_extended(jnp.array(mean), len(s)) for mean in self.means])
        stds = jnp.array(self.stds)
        each = -0.5 * jnp.sum((s[None] - means) ** 2, -1) / stds**2 - len(s) * jnp.log(stds)
        weights = jnp.array(self.weights) / sum(self.weights)
        return jax.nn.logsumexp(each, b=weights) - 0.5 * len(s) * jnp.log(2 * jnp.pi)


def _extended(mean: Array, size: int) -> Array:
    """The first `size` entries, the last one repeated where there are fewer."""
    return jnp.pad(mean, (0, max(0, size - len(mean))), mode="edge")[:size]
