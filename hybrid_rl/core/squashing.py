"""Policies u = tanh(z), z ~ N(mu, diag(sigma^2)), and their density (Haarnoja et al. 2018, eq. 21).

log pi(u) = log N(z; mu, sigma) - sum_i log(1 - tanh(z_i)^2)
"""

from abc import ABC, abstractmethod
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array
from jax.scipy.stats import norm

EDGE = 1 - 1e-6  # largest action whose z is known to float32


def log_density(z: Array, noise: Array, sigma: Array) -> Array:
    """Log-density [..., m] of each entry of tanh(z), z = mu + sigma noise."""
    log_normal = -0.5 * noise**2 - jnp.log(sigma) - 0.5 * jnp.log(2 * jnp.pi)
    log_jacobian = 2 * (jnp.log(2.0) - z - jax.nn.softplus(-2 * z))
    return log_normal - log_jacobian


def sampled(mu: Array, sigma: Array, noise: Array) -> tuple[Array, Array]:
    """The action u = tanh(mu + sigma noise) [..., m], and log pi(u) [...]."""
    z = mu + sigma * noise
    return jnp.tanh(z), jnp.sum(log_density(z, noise, sigma), axis=-1)


class Squashed(ABC):
    """What policies tanh(z), z ~ N(mu(x), diag(sigma(x)^2)) share."""

    @abstractmethod
    def gaussian(self, params: dict[str, Any], x: Array) -> tuple[Array, Array]:
        """The mean mu and standard deviation sigma [..., m] before tanh, at x [..., n]."""

    def mean(self, params: dict[str, Any], x: Array) -> Array:
        """tanh(mu(x)) [..., m]."""
        return jnp.tanh(self.gaussian(params, x)[0])

    def variance(self, params: dict[str, Any], x: Array) -> Array:
        """Variance of the action [..., m], to first order around the mean: (1 - mean^2)^2 sigma^2.

        The delta method, accurate for a narrow policy; for a wide one it is too large in the middle
        of the range (2.5 times with sigma = 1) and too small near the bounds.
        """
        mu, sigma = self.gaussian(params, x)
        return ((1 - jnp.tanh(mu) ** 2) * sigma) ** 2

    def sample(self, params: dict[str, Any], x: Array, noise: Array) -> tuple[Array, Array]:
        """The action u [..., m] for noise [..., m] ~ N(0, I), and log pi(u|x) [...]."""
        return sampled(*self.gaussian(params, x), noise)

    def log_prob(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """log pi(u|x) [...] of u [..., m], x [..., n]; beyond EDGE the log-probability of that."""
        mu, sigma = self.gaussian(params, x)
        z = jnp.arctanh(jnp.clip(u, -EDGE, EDGE))
        beyond = norm.logcdf(jnp.sign(u) * (mu - z) / sigma)
        inside = log_density(z, (z - mu) / sigma, sigma)
        return jnp.sum(jnp.where(jnp.abs(u) > EDGE, beyond, inside), axis=-1)
