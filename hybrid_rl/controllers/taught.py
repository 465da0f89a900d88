"""A teacher acts for the first decisions of the run, then a learner's controller."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.protocols import Controller
from hybrid_rl.types import Params, Spec


@dataclass(frozen=True)
class TaughtController:
    """`teacher` for `decisions` decisions of the run, then `controller`.

    Raises:
        ValueError: without a teacher, or for a negative number of decisions.
    """

    teacher: Controller | None
    controller: Controller
    decisions: int = 100

    def __post_init__(self) -> None:
        """Check the fields."""
        if self.teacher is None:
            raise ValueError("expert=null: no teacher; choose a task with an expert, or an expert")
        if self.decisions < 0:
            raise ValueError(f"taught.decisions={self.decisions}: must be 0 or more")

    def init(self, spec: Spec) -> tuple[Any, Any]:
        """The initial states of both."""
        assert self.teacher is not None
        return self.teacher.init(spec), self.controller.init(spec)

    def act(
        self, params: Params, state: tuple[Any, Any], obs: Array, key: Array
    ) -> tuple[Array, tuple[Any, Any], dict[str, Array]]:
        """Action [m], next state, no metrics. The key is consumed."""

        def teach() -> tuple[Array, tuple[Any, Any]]:
            assert self.teacher is not None
            u, after, _ = self.teacher.act(params, state[0], obs, key)
            return u, (after, state[1])

        def act() -> tuple[Array, tuple[Any, Any]]:
            u, after, _ = self.controller.act(params, state[1], obs, key)
            return u, (state[0], after)

        now = self.decisions if params.decisions is None else params.decisions
        u, state = jax.lax.cond(jnp.asarray(now) < self.decisions, teach, act)
        return u, state, {}

    def greedy(self) -> Controller:
        """The learner's controller without exploration."""
        return self.controller.greedy()
