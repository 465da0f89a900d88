"""Worlds that step outside JAX, and what makes those of the user."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NoReturn

import jax.numpy as jnp
from jax import Array

from hybrid_rl.errors import FAULTS, UsageError, user_line
from hybrid_rl.files import targets as parts
from hybrid_rl.types import EnvState, Spec

ALONE = "steps by itself; no method can plan on it, and evaluate and render cannot step it "
ALONE += "(`python -m hybrid_rl.robot run=DIR` moves a robot)"


class Unstepped:
    """A world of which JAX knows the sizes alone."""

    spec: Spec

    def reset(self, key: Array) -> EnvState:
        """A state with zeros for the observation; the loop puts the true one."""
        return EnvState((), jnp.zeros(self.spec.obs), jnp.zeros(()))

    def step(self, state: EnvState, action: Array) -> NoReturn:
        """No JAX function."""
        line = "steps outside JAX, so no method can plan on it; choose one that learns its model"
        raise UsageError(f"{type(self).__name__}: {line}, such as algo=nn_mppi or sac")


@dataclass(frozen=True)
class Made(Unstepped):
    """A world that a class or a function of the user's makes."""

    make: str | Callable[..., Any] = ""  # MODULE:NAME, or the class or function itself
    kwargs: Mapping[str, Any] | None = None  # of it

    def __post_init__(self) -> None:
        object.__setattr__(self, "kwargs", Items(self.kwargs or {}))

    @property
    def name(self) -> str:
        """What messages call it."""
        return str(getattr(self.make, "__name__", self.make))


class Items(dict):
    """Settings of an environment: a dictionary that is not changed, with a hash."""

    def __hash__(self) -> int:
        return hash(repr(sorted(self.items(), key=repr)))


def import_named(make: Any) -> Callable[..., Any]:
    """The function or class that `MODULE:NAME` names; what is no text stays as it is."""
    if not isinstance(make, str):
        return make
    try:
        return getattr(*parts.imported(make))
    except FAULTS as error:  # whatever the user's module does
        line = user_line(error) or error
        raise UsageError(f"env.make={make}: cannot be imported ({line})") from error


def registered(name: str) -> str:
    """The id of MODULE:ID, whose module registers it; any other name as it is."""
    return parts.imported(name)[1] if ":" in name else name
