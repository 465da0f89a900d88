"""Cart and double pendulum: two rods balanced on a cart that moves along a rail.

    M(q) q'' + h(q, q') = (u, 0, 0),   q = (x, th1, th2), angles from upright, absolute
    M = [[m0+m1+m2, (m1 l1 + m2 L1) c1, m2 l2 c2], [., m1 l1^2 + m2 L1^2 + I1, m2 L1 l2 c12],
         [., ., m2 l2^2 + I2]],   l = L/2, I = m L^2 / 12
    hills    r = phi(x) of `envs/analytic/state.py`, after the step
    upright  r = cos th1 + cos th2 - 0.1 x^2

o = (x, th1, th2, x', th1', th2') [6]; a: force on the cart, as a fraction of 40 N; start:
x ~ U(-0.8, 0.8), all else 0; a decision is one Runge-Kutta step of 0.01 s; terminates when a rod
is more than 90 degrees from upright.

Source: masses and lengths from Bogdanov 2004 (the thesis gives none); start from thesis section
6.3.1.
"""

from typing import Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic.state import Euclidean, fully_observed, phi, rk4
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.fields import part
from hybrid_rl.types import EnvState, Spec

DT, FORCE, G = 0.01, 40.0, 9.81  # [s], [N], [m/s^2]
M0, M1, M2 = 1.5, 0.5, 0.75  # [kg]
L1, L2 = 0.5, 0.75  # [m]


@part
class CartDoublePendulum(Euclidean):
    """Cart and double pendulum; `reward` is hills or upright."""

    reward: Literal["hills", "upright"] = "hills"

    spec = Spec(obs=6, act=1, dt=DT)

    def initial(self, key: Array) -> Array:
        """A random initial observation [6]."""
        return jnp.zeros(6).at[0].set(jax.random.uniform(key, (), jnp.float32, -0.8, 0.8))

    def _state(self, x: Array, reward: Array, info: dict[str, Array]) -> EnvState:
        return fully_observed(x, reward, jnp.any(jnp.abs(x[1:3]) > jnp.pi / 2))

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [1] at x [6], which led to `after` [6]."""
        if self.reward == "hills":
            return phi(after[0])
        return jnp.cos(after[1]) + jnp.cos(after[2]) - 0.1 * after[0] ** 2

    def dynamics(self, x: Array, u: Array) -> Array:
        """The next observation [6] after action u [1] at x [6]."""
        return rk4(lambda x: _rate(x, FORCE * u[0]), x, DT)

    scene = mjcf.scene("cart_double_pendulum.xml")

    def pose(self, state: EnvState) -> Array:
        """Joint positions qpos [3] for rendering; the second angle is relative to the first rod."""
        x = state.data
        return jnp.stack((x[0], x[1], x[2] - x[1]))


def _rate(x: Array, u: Array) -> Array:
    """Time derivative [6] of the state x [6] under the force u [] [N]."""
    a, b, w, v = x[1], x[2], x[4], x[5]
    s1, s2, s12, c12 = jnp.sin(a), jnp.sin(b), jnp.sin(a - b), jnp.cos(a - b)
    first, second, both = M1 * L1 / 2 + M2 * L1, M2 * L2 / 2, M2 * L1 * L2 / 2
    c1, c2 = first * jnp.cos(a), second * jnp.cos(b)
    i1, i2 = (M1 / 3 + M2) * L1**2, M2 * L2**2 / 3
    mass = jnp.array([[M0 + M1 + M2, c1, c2], [c1, i1, both * c12], [c2, both * c12, i2]])
    force = u + first * s1 * w**2 + second * s2 * v**2
    torques = [first * G * s1 - both * s12 * v**2, second * G * s2 + both * s12 * w**2]
    return jnp.concatenate([x[3:], jnp.linalg.solve(mass, jnp.stack([force, *torques]))])
