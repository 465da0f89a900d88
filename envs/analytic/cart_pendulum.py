"""Cart pendulum: a rod balanced on a cart that moves along a rail, without friction.

    (M + m) x'' + (m l/2) (cos th th'' - sin th th'^2) = u
    (m l/2) cos th x'' + (m l^2/3) th'' = (m g l/2) sin th
    r = cos th - 0.1 x^2, after the step

o = (th, x, th', x') [4], th = 0 is upright, th > 0 leans towards x > 0; a: force u on the cart, as
a fraction of `force`; start: all four ~ U(-start, start); a decision is `dt`, four Runge-Kutta
steps; terminates outside |th| < `angle_limit`, |x| < `position_limit`. Metric: success = inside.
r is positive inside the default limits.

Source: thesis section 7.4 and appendix D: 50 Hz, order of the state; masses, length and force of
pybullet's inverted pendulum, as in assets/cartpole.xml, with a thin rod. Limits, start and reward
are our choice.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic.state import Euclidean, fully_observed, rk4
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.fields import Positive, part
from hybrid_rl.types import EnvState, Spec

G = 9.81  # [m/s^2]
SUBSTEPS = 4  # Runge-Kutta steps of a decision


@part
class CartPendulum(Euclidean):
    """A rod on a cart, to be balanced."""

    cart_mass: Positive = 10.472  # [kg] M
    rod_mass: Positive = 5.019  # [kg] m
    length: Positive = 0.6  # [m] l
    force: Positive = 100.0  # [N] at a = 1
    dt: Positive = 0.02  # [s] of a decision
    start: Positive = 0.1  # [rad, m, rad/s, m/s] largest initial value of each entry
    angle_limit: Positive = 0.5  # [rad]
    position_limit: Positive = 2.0  # [m]

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        return Spec(obs=4, act=1, dt=self.dt)

    def initial(self, key: Array) -> Array:
        """A random initial observation [4]."""
        return jax.random.uniform(key, (4,), jnp.float32, -self.start, self.start)

    def _state(self, x: Array, reward: Array, info: dict[str, Array]) -> EnvState:
        inside = (jnp.abs(x[0]) < self.angle_limit) & (jnp.abs(x[1]) < self.position_limit)
        metrics = {"success": inside.astype(jnp.float32)}
        return fully_observed(x, reward, ~inside).replace(metrics=metrics)

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [1] at x [4], which led to `after` [4]."""
        return jnp.cos(after[0]) - 0.1 * after[1] ** 2

    def dynamics(self, x: Array, u: Array) -> Array:
        """The next observation [4] after action u [1] at x [4]."""
        dt = self.dt / SUBSTEPS
        return rk4(lambda x: self._rate(x, self.force * u[0]), x, dt, SUBSTEPS)

    def _rate(self, x: Array, u: Array) -> Array:
        """Time derivative [4] of the state x [4] under the force u [] [N]."""
        total, moment = self.cart_mass + self.rod_mass, 0.5 * self.rod_mass * self.length
        inertia = self.rod_mass * self.length**2 / 3
        sin, cos = jnp.sin(x[0]), jnp.cos(x[0])
        push, torque = u + moment * sin * x[2] ** 2, moment * G * sin
        det = total * inertia - (moment * cos) ** 2
        turn = (total * torque - moment * cos * push) / det
        return jnp.stack([x[2], x[3], turn, (inertia * push - moment * cos * torque) / det])

    def scene(self) -> str:
        """MJCF text of the scene for rendering."""
        return mjcf.text("cart_pendulum.xml").replace("0 0 0 0 0 0.6", f"0 0 0 0 0 {self.length}")

    def pose(self, state: EnvState) -> Array:
        """Position of the cart and angle of the rod, qpos [2], for rendering."""
        return jnp.stack((state.data[1], state.data[0]))
