"""No dynamics: the action is the next position on the rail.

    x' = u,   r = phi(x') of `envs/analytic/state.py`

o = x [1] in [-1, 1] m; start: x ~ U(-0.8, 0.8); a decision is 0.2 s, the interval between two
measurements of the cart and double pendulum; never terminates.

Source: thesis section 6.3.1, Bayesian optimisation without dynamics.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic.state import Euclidean, phi
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.fields import part
from hybrid_rl.types import Spec

DT = 0.2  # [s] of a decision


@part
class NoDynamics(Euclidean):
    """A point that moves to any position within one decision."""

    spec = Spec(obs=1, act=1, dt=DT)

    def initial(self, key: Array) -> Array:
        """A random initial observation [1]."""
        return jax.random.uniform(key, (1,), jnp.float32, -0.8, 0.8)

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [1] at x [1], which led to `after` [1]."""
        return phi(after[0])

    def dynamics(self, x: Array, u: Array) -> Array:
        """The next observation [1] after action u [1] at x [1]."""
        return u + 0 * x

    scene = mjcf.scene("no_dynamics.xml")
