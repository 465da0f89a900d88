"""Worlds that step outside JAX."""

from typing import NoReturn

import jax.numpy as jnp
from jax import Array

from hybrid_rl.errors import UsageError
from hybrid_rl.types import EnvState, Spec


class Unstepped:
    """A world of which JAX knows the sizes alone."""

    spec: Spec

    def reset(self, key: Array) -> EnvState:
        """A state with zeros for the observation; the loop puts the true one."""
        zero, no = jnp.zeros(()), jnp.zeros((), bool)
        return EnvState((), jnp.zeros(self.spec.obs), zero, no, no)

    def step(self, state: EnvState, action: Array) -> NoReturn:
        """No JAX function.

        Raises:
            UsageError: always.
        """
        raise UsageError(
            f"{type(self).__name__}: steps by itself; no method can plan on it, and evaluate and "
            "render cannot step it (`python -m hybrid_rl.robot run=DIR` moves a robot)"
        )
