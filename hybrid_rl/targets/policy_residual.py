"""p(s) ~ the squared difference between a policy and the labels near s.

    p(s) ~ |pi(s) - u(s)|^2 + floor,   u(s) = sum_i w_i u_i / sum_i w_i,
    w_i = exp(-|(s - s_i) / (h scale)|^2 / 2)   over the labels (s_i, u_i) so far

u is kernel regression (Nadaraya 1964, Watson 1964), which follows the labels at once where a clone
needs many gradient steps. As a choice of queries it is ours: where the two disagree, the clone has
not learned what the labels show, or there is no label nearby.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Positive, part
from hybrid_rl.protocols import Policy
from hybrid_rl.types import Params


@part
class PolicyResidual:
    """Proportional to the squared difference to a kernel regression of the labels."""

    policy: Policy
    bandwidth: Positive = 0.5  # h, in standard deviations of the first demonstration
    floor: Positive = 1e-6

    def log_density(self, params: Params, s: Array) -> Array:
        """log p [] at the planning state s [n], up to a constant; needs params.labels."""
        known = params.labels.labels
        away = (known.obs - s[None]) / (self.bandwidth * params.labels.scale)[None]
        filled = jnp.arange(len(away)) < known.count
        log_w = jnp.where(filled, -0.5 * jnp.sum(away**2, 1), -jnp.inf)
        u = jax.nn.softmax(jnp.where(known.count > 0, log_w, 0.0)) @ known.action
        return jnp.log(jnp.sum((self.policy.mean(params.policy, s) - u) ** 2) + self.floor)
