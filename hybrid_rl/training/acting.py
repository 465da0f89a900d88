"""A trained controller as a function from observations to actions."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core.batching import repeat
from hybrid_rl.protocols import Controller
from hybrid_rl.training.given import check_finite
from hybrid_rl.types import Params, PyTree, Spec


class TrainedPolicy:
    """action = policy(obs): a trained controller without exploration, for one world or N.

    obs is [o], or [N, o] of N worlds side by side; the action is [m] or [N, m], in [-1, 1] or, with
    `span` = (middle [m], half the width [m]), within these bounds. `flat` makes [o] of the
    dictionary that a Gymnasium environment may return. A planner keeps its plan from one call to
    the next, so call `reset` when an episode begins.
    """

    def __init__(
        self,
        spec: Spec,
        controller: Controller,
        params: Params,
        key: int = 0,
        span: tuple[np.ndarray, np.ndarray] | None = None,
        flat: Callable[[Mapping[str, Any]], np.ndarray] | None = None,
    ) -> None:
        self.spec, self._key, self._span, self._flat = spec, jax.random.key(key), span, flat
        self._begin = partial(controller.init, spec)
        self._state: PyTree = None  # [N, ...]; None: an episode begins
        self._worlds = 0  # N

        def act(state: Any, obs: Array, key: Array) -> tuple[Array, Any, Array]:
            key, *keys = jax.random.split(key, 1 + len(obs))
            each = jax.vmap(controller.act, (None, 0, 0, 0))
            u, state, _ = each(params, state, obs, jnp.stack(keys))
            return u, state, key

        self._act = jax.jit(act)

    def reset(self, where: np.ndarray | None = None) -> None:
        """Begin an episode; where: [N] bool, only in these worlds."""
        if where is None:
            self._state = None
        elif self._state is not None:
            first = self._begin()
            each = jax.vmap(lambda new, now: jax.tree.map(partial(jnp.where, new), first, now))
            self._state = each(jnp.asarray(where), self._state)

    def __call__(self, obs: np.ndarray | Mapping[str, Any]) -> np.ndarray:
        """The action [m] at obs [o], or actions [N, m] at [N, o].

        Raises:
            ValueError: for observations of another size or that are not finite, or another N than
                since the reset.
        """
        if self._flat is not None and isinstance(obs, Mapping):
            obs = self._flat(obs)
        o = self.spec.obs
        try:
            values = np.asarray(obs, np.float32)
            found = "" if values.ndim in (1, 2) and values.shape[-1] == o else str(values.shape)
        except (TypeError, ValueError):
            values, found = None, "no array of numbers, as (obs, info) of env.reset() is none"
        if values is None or found:
            raise ValueError(f"obs is {found}; it must be [{o}] or [N, {o}]")
        rows = np.atleast_2d(values)
        check_finite("obs", rows)
        if self._state is None:
            self._worlds = len(rows)
            self._state = repeat(self._begin(), len(rows))
        if len(rows) != self._worlds:
            raise ValueError(f"obs of {len(rows)} worlds after {self._worlds}; reset() first")
        u, self._state, self._key = self._act(self._state, rows, self._key)
        u = np.asarray(u).reshape(*values.shape[:-1], self.spec.act)
        return u if self._span is None else self._span[0] + self._span[1] * np.clip(u, -1, 1)
