"""Fully observed environments: their state, what those whose states are vectors share, and rk4."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import EnvState, Spec

PEAKS = ((-0.6, 0.15, 0.6), (0.05, 0.12, 0.8), (0.65, 0.1, 1.0))  # centre [m], width [m], height


def fully_observed(x: Array, reward: Array, terminated: Array | bool = False) -> EnvState:
    """The state of an environment whose observation is its whole state x [o]."""
    return EnvState(x, x, reward, jnp.asarray(terminated))


class Euclidean(ABC):
    """An analytic world whose states are vectors; local coordinates are x less the equilibrium."""

    spec: Spec

    @abstractmethod
    def initial(self, key: Array) -> Array:
        """A random initial observation [o]."""

    @abstractmethod
    def dynamics(self, x: Array, u: Array) -> Array:
        """The next observation [o] after action u [m] at x [o]."""

    @abstractmethod
    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [m] at x [o], which led to `after` [o]."""

    def equilibrium(self) -> tuple[Array, Array]:
        """The observation [o] and the action [m] at rest: 0, unless a world says otherwise."""
        return jnp.zeros(self.spec.obs), jnp.zeros(self.spec.act)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        return self._state(self.initial(key), jnp.float32(0.0), {})

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [m] in [-1, 1]."""
        u = jnp.clip(action, -1.0, 1.0)
        x = self.dynamics(state.data, u)
        return self._state(x, self.reward_of(state.data, u, x), state.info)

    def _state(self, x: Array, reward: Array, info: dict[str, Array]) -> EnvState:
        """At x [o]; info: of the state before, {} at a reset."""
        return fully_observed(x, reward)

    def pose(self, state: EnvState) -> Array:
        """Joint positions qpos [nq] for rendering: the state, unless a world says otherwise."""
        return state.data

    def to_local(self, x: Array) -> Array:
        """Local coordinates e [o] of the observation x [o]."""
        return x - self.equilibrium()[0]

    def from_local(self, e: Array) -> Array:
        """The observation [o] at local coordinates e [o]."""
        return self.equilibrium()[0] + e


def phi(x: Array) -> Array:
    """sum_i h_i exp(-(x - c_i)^2 / (2 w_i^2)) [...] at x [...] [m]; the highest peak is at 0.65."""
    each = [h * jnp.exp(-0.5 * ((x - centre) / width) ** 2) for centre, width, h in PEAKS]
    return sum(each[1:], each[0])


def rk4(f: Callable[[Any], Any], x: Any, dt: float, steps: int = 1) -> Any:
    """The solution of dx/dt = f(x) after `steps` of dt [s], by the classical Runge-Kutta method.

    x is any pytree of arrays.
    """

    def add(x: Any, k: Any, scale: float) -> Any:
        return jax.tree.map(lambda x, k: x + scale * k, x, k)

    for _ in range(steps):
        a = f(x)
        b = f(add(x, a, dt / 2))
        c = f(add(x, b, dt / 2))
        d = f(add(x, c, dt))
        slope = jax.tree.map(lambda a, b, c, d: (a + 2 * b + 2 * c + d) / 6, a, b, c, d)
        x = add(x, slope, dt)
    return x
