"""Cart swing-up: a rod is swung up by a cart whose acceleration is the action.

    th'' = g / l sin th + u / l cos th - d th',   x'' = u - c x'
    r = cos th - 0.1 x^8 - 0.01 u^2, after the step

o = (th, x, th', x') [4], th = 0 is upright, th > 0 leans towards x < 0, th is not wrapped; a:
acceleration u, as a fraction of `acceleration`; start: N((pi, 0, 0, 0), start^2 1); a decision is
two Euler steps of 0.02 s; terminates where |x| > `rail` or |th - pi| > 2 pi `turns`, if given.
Metric: success = cos th > 0.9.

Source: state and reward from thesis section 4.1, which refers to another text for the dynamics.
These, with their length, friction, limit of the action and start, are those of the author's own
code for hybrid learning (custom_cartpoleswingup), where th > 0 leans to the left and the rail is
2.4 m long in each direction. That a decision is two steps, and that the rail has no end unless one
is given, is our choice.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic.cart_pendulum import CartPendulum
from hybrid_rl.envs.analytic.state import Euclidean, fully_observed
from hybrid_rl.fields import NotNegative, Positive, part
from hybrid_rl.types import EnvState, Spec

G = 9.81  # [m/s^2]
DT = 0.02  # [s] of an Euler step
SUBSTEPS = 2  # Euler steps of a decision
UPRIGHT = 0.9  # least cos th of a success


@part
class CartSwingUp(Euclidean):
    """A rod on a cart, to be swung up."""

    length: Positive = 0.6  # [m] l, to the rod's mass
    acceleration: Positive = 10.0  # [m/s^2] at a = 1
    damping: NotNegative = 0.2  # [1/s] d
    friction: NotNegative = 0.1  # [1/s] c
    start: NotNegative = 0.2  # [rad, m, rad/s, m/s] standard deviation of each entry at the start
    rail: Positive | None = None  # [m] |x| that ends an episode; None: none does
    turns: Positive | None = None  # of the rod, in either direction, that end one; None: none do

    spec = Spec(obs=4, act=1, dt=SUBSTEPS * DT)

    def initial(self, key: Array) -> Array:
        """A random initial observation [4]: the rod hangs."""
        return jnp.array([jnp.pi, 0, 0, 0]) + self.start * jax.random.normal(key, (4,))

    def _state(self, x: Array, reward: Array, info: dict[str, Array]) -> EnvState:
        upright = (jnp.cos(x[0]) > UPRIGHT).astype(jnp.float32)
        off = jnp.abs(x[1]) > (self.rail or jnp.inf)
        wound = jnp.abs(x[0] - jnp.pi) > 2 * jnp.pi * (self.turns or jnp.inf)
        return fully_observed(x, reward, off | wound).replace(metrics={"success": upright})

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [1] at x [4], which led to `after` [4]."""
        effort = 0.01 * (self.acceleration * u[0]) ** 2
        return jnp.cos(after[0]) - 0.1 * after[1] ** 8 - effort

    def dynamics(self, x: Array, u: Array) -> Array:
        """The next observation [4] after action u [1] at x [4]."""
        push = self.acceleration * u[0]
        for _ in range(SUBSTEPS):
            torque = G * jnp.sin(x[0]) + push * jnp.cos(x[0])
            turn = torque / self.length - self.damping * x[2]
            rate = jnp.stack([x[2], x[3], turn, push - self.friction * x[3]])
            x = x + DT * rate
        return x

    scene = CartPendulum.scene

    def pose(self, state: EnvState) -> Array:
        """Position of the cart and angle of the rod, qpos [2], for rendering."""
        return jnp.stack((state.data[1], -state.data[0]))
