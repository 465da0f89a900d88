"""Fully observed environments: their state, and what those whose states are vectors share."""

from abc import ABC, abstractmethod

import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import EnvState, Spec


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

    def to_local(self, x: Array) -> Array:
        """Local coordinates e [o] of the observation x [o]."""
        return x - self.equilibrium()[0]

    def from_local(self, e: Array) -> Array:
        """The observation [o] at local coordinates e [o]."""
        return self.equilibrium()[0] + e
