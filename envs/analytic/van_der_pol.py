"""Van der Pol's oscillator with a control.

    x1' = x2,   x2' = -x1 + (1 - x1^2) x2 + u
    r = -(|x|^2 + 0.1 u^2), of the state after the step

o = (x1, x2) [2], without units; a: u, as a fraction of 20; start: x ~ U(-start, start)^2; a
decision is one Runge-Kutta step of 0.01 s; never terminates. Without control it moves on a limit
cycle, on which |x1| <= 2.009.

Source: thesis section 7.1, whose weights are those of r; time step from the author's
active-learning-koopman; scale of the action and start are our choice.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic.state import Euclidean, rk4
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.fields import Positive, part
from hybrid_rl.types import Spec

DT = 0.01  # [s] of a decision
FORCE = 20.0  # u at a = 1


@part
class VanDerPol(Euclidean):
    """Van der Pol's oscillator, to be stopped at the origin."""

    start: Positive = 2.0  # largest initial |x1| and |x2|

    spec = Spec(obs=2, act=1, dt=DT)

    def initial(self, key: Array) -> Array:
        """A random initial observation [2]."""
        return jax.random.uniform(key, (2,), jnp.float32, -self.start, self.start)

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [1] at x [2], which led to `after` [2]."""
        return -(jnp.sum(after**2) + 0.1 * (FORCE * u[0]) ** 2)

    def dynamics(self, x: Array, u: Array) -> Array:
        """The next observation [2] after action u [1] at x [2]."""
        return rk4(lambda x: _rate(x, FORCE * u[0]), x, DT)

    scene = mjcf.scene("van_der_pol.xml")


def _rate(x: Array, u: Array) -> Array:
    """Time derivative [2] of x [2] under the control u []."""
    return jnp.stack([x[1], -x[0] + (1 - x[0] ** 2) * x[1] + u])
