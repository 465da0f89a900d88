"""s = (o_t, v_t, u_{t-1}, ..., v_{t-k+2}, u_{t-k+1}): what was seen and done lately.

    v_t = (o_t - o_{t-1}) / dt

It stands in for what an observation lacks, such as velocities or a load (a state of order k;
Bertsekas, Dynamic Programming and Optimal Control I, section 1.4). Rates say the same as the k
observations themselves, of which networks would have to learn small differences. Before the first
decision of an episode nothing moved, and the actions were 0.
"""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import Spec


def seen(spec: Spec, k: int) -> Spec:
    """The sizes for what sees s, of k observations; `spec` itself for 1."""
    size = k * spec.obs + (k - 1) * spec.act
    return spec if k == 1 else spec._replace(obs=size, newest=spec.obs)


def first(obs: Array, size: int) -> Array:
    """s [size] at the first observation [o] of an episode."""
    return jnp.concatenate((obs, jnp.zeros(size - obs.size, obs.dtype)))


def shifted(s: Array, u: Array, obs: Array, dt: Array | float) -> Array:
    """The next s [n] after action u [m] at s [n] led to obs [o] within dt [s]."""
    rate = (obs - s[: obs.size]) / dt
    return jnp.concatenate((obs, rate, u, s[obs.size :]))[: s.size]
