"""p(s) = sum_j w_j N(s; m_j, s_j^2 I): a known target."""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import FieldError, Positive, part
from hybrid_rl.types import Params


@part
class Mixture:
    """A mixture of any number of Gaussians, of any dimension."""

    means: tuple[tuple[float, ...], ...] = ((0.3,), (0.7,))  # [J, v]
    stds: tuple[Positive, ...] = (0.1, 0.1)  # [J]
    weights: tuple[Positive, ...] = (0.5, 0.5)  # [J], up to a factor

    def __post_init__(self) -> None:
        for name in ("stds", "weights"):
            if len(getattr(self, name)) != len(self.means):
                raise FieldError(self, name, "one number above 0 for each mean")

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at s [v]; the last entry of a shorter mean is repeated."""
        more = (jnp.pad(jnp.array(m), (0, len(s) - len(m)), mode="edge") for m in self.means)
        means = jnp.stack([*more])
        stds = jnp.array(self.stds)
        each = -0.5 * jnp.sum((s[None] - means) ** 2, -1) / stds**2 - len(s) * jnp.log(stds)
        weights = jnp.array(self.weights) / sum(self.weights)
        return jax.nn.logsumexp(each, b=weights) - 0.5 * len(s) * jnp.log(2 * jnp.pi)
