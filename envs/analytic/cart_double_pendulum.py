"""Cart and double pendulum: two rods balanced on a cart, which is free to look around.

    M(q) q'' + h(q, q') = (u, 0, 0),   q = (x, th1, th2), angles from upright, absolute
    M = [[m0+m1+m2, (m1 l1 + m2 L1) c1, m2 l2 c2], [., m1 l1^2 + m2 L1^2 + I1, m2 L1 l2 c12],
         [., ., m2 l2^2 + I2]],   l = L/2, I = m L^2 / 12
    hills    r = phi(x), after the step: what there is to find along the rail
    upright  r = cos th1 + cos th2 - 0.1 x^2

o = (x, th1, th2, x', th1', th2') [6]; the motor gives 40 N; start: x U(-0.8, 0.8), all else at
rest; a decision is one Runge-Kutta step of 0.01 s; terminates where a rod lies level.

Source: Bogdanov 2004 for the figures (the thesis gives none); thesis section 6.3.1 for the start.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic import integrate
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.options import one_of
from hybrid_rl.types import EnvState, Spec

DT, FORCE, G = 0.01, 40.0, 9.81  # [s], [N], [m/s^2]
M0, M1, M2 = 1.5, 0.5, 0.75  # [kg]
L1, L2 = 0.5, 0.75  # [m]


@dataclass(frozen=True)
class CartDoublePendulum:
    """Stands up."""

    reward: str = "hills"  # or upright

    def __post_init__(self) -> None:
        one_of("reward", self.reward, ("hills", "upright"))

    @property
    def spec(self) -> Spec:
        """Sizes and rate."""
        return Spec(obs=6, act=1, dt=DT)

    def reset(self, key: Array) -> EnvState:
        """A first state, drawn with `key`."""
        x = jax.random.uniform(key, (), jnp.float32, -0.8, 0.8)
        return integrate.state(jnp.zeros(6).at[0].set(x), jnp.float32(0.0))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [1] in [-1, 1]."""
        x = self.dynamics(state.data, jnp.clip(action, -1.0, 1.0))
        reward = integrate.hills(x[0])
        if self.reward == "upright":
            reward = jnp.cos(x[1]) + jnp.cos(x[2]) - 0.1 * x[0] ** 2
        return integrate.state(x, reward, jnp.any(jnp.abs(x[1:3]) > jnp.pi / 2))

    def dynamics(self, x: Array, u: Array) -> Array:
        """The observation [6] that follows x [6] under u [1]."""
        return integrate.rk4(lambda x: _rate(x, FORCE * u[0]), x, DT)

    def equilibrium(self) -> tuple[Array, Array]:
        """Upright, in the middle of the rail."""
        return jnp.zeros(6), jnp.zeros(1)

    def to_local(self, x: Array) -> Array:
        """Local coordinates e [6] of x [6]."""
        return x

    def from_local(self, e: Array) -> Array:
        """The observation [6] of e [6]."""
        return e

    def scene(self) -> str:
        """MJCF text of the world as it is drawn."""
        return mjcf.text("cart_double_pendulum.xml")

    def pose(self, state: EnvState) -> Array:
        """Positions qpos [3] of the drawn world, where the second angle is that of its joint."""
        x = state.data
        return jnp.stack((x[0], x[1], x[2] - x[1]))


def _rate(x: Array, u: Array) -> Array:
    """D x / dt [6] under the force u [] [N]."""
    a, b, w, v = x[1], x[2], x[4], x[5]
    s1, s2, s12, c12 = jnp.sin(a), jnp.sin(b), jnp.sin(a - b), jnp.cos(a - b)
    first, second, both = M1 * L1 / 2 + M2 * L1, M2 * L2 / 2, M2 * L1 * L2 / 2
    c1, c2 = first * jnp.cos(a), second * jnp.cos(b)
    i1, i2 = (M1 / 3 + M2) * L1**2, M2 * L2**2 / 3
    all_ = jnp.full_like(a, M0 + M1 + M2)
    mass = jnp.stack(
        [
            jnp.stack([all_, c1, c2]),
            jnp.stack([c1, i1 + 0 * a, both * c12]),
            jnp.stack([c2, both * c12, i2 + 0 * a]),
        ]
    )
    push = u + first * s1 * w**2 + second * s2 * v**2
    torques = [first * G * s1 - both * s12 * v**2, second * G * s2 + both * s12 * w**2]
    return jnp.concatenate([x[3:], jnp.linalg.solve(mass, jnp.stack([push, *torques]))])
