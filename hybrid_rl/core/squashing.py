"""The density of u = tanh(z), z ~ N(mu, diag(sigma^2)) (Haarnoja et al. 2018, eq. 21).

log pi(u) = log N(z; mu, sigma) - sum_i log(1 - tanh(z_i)^2)
"""

import jax
import jax.numpy as jnp
from jax import Array


def log_density(z: Array, noise: Array, sigma: Array) -> Array:
    """Log-density [...] of tanh(z), z = mu + sigma noise, for arguments [..., m]."""
    log_normal = -0.5 * noise**2 - jnp.log(sigma) - 0.5 * jnp.log(2 * jnp.pi)
    log_jacobian = 2 * (jnp.log(2.0) - z - jax.nn.softplus(-2 * z))
    return jnp.sum(log_normal - log_jacobian, axis=-1)
