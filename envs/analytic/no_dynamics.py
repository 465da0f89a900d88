"""No dynamics: no robot, only the search; an action is a place on the rail, and one is there.

    x' = u,   r = phi(x) of envs/analytic/integrate.py, after the step

o = x [1] in [-1, 1] m; start: x U(-0.8, 0.8); a decision takes as long as a robot's between two
measurements, 0.2 s; never terminates. Source: thesis section 6.3.1, optimisation without dynamics.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic import integrate
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.types import EnvState, Spec

DT = 0.2  # [s] of a decision


@dataclass(frozen=True)
class NoDynamics:
    """Is where it wants."""

    @property
    def spec(self) -> Spec:
        """Sizes and rate."""
        return Spec(obs=1, act=1, dt=DT)

    def reset(self, key: Array) -> EnvState:
        """A first state, drawn with `key`."""
        x = jax.random.uniform(key, (1,), jnp.float32, -0.8, 0.8)
        return integrate.state(x, jnp.float32(0.0))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [1] in [-1, 1]."""
        x = self.dynamics(state.data, jnp.clip(action, -1.0, 1.0))
        return integrate.state(x, integrate.hills(x[0]))

    def dynamics(self, x: Array, u: Array) -> Array:
        """The observation [1] that follows x [1] under u [1]."""
        return u + 0 * x

    def equilibrium(self) -> tuple[Array, Array]:
        """In the middle."""
        return jnp.zeros(1), jnp.zeros(1)

    def to_local(self, x: Array) -> Array:
        """Local coordinates e [1] of x [1]."""
        return x

    def from_local(self, e: Array) -> Array:
        """The observation [1] of e [1]."""
        return e

    def scene(self) -> str:
        """MJCF text of the world as it is drawn."""
        return mjcf.text("no_dynamics.xml")

    def pose(self, state: EnvState) -> Array:
        """Positions qpos [1] of the drawn world."""
        return state.data
