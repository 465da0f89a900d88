"""One controller after the other within an episode or a run: warm up, explore, then track."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Natural, part
from hybrid_rl.protocols import Controller
from hybrid_rl.types import Params, Spec


class StagesState(NamedTuple):
    """The states of all stages."""

    each: dict[str, Any]
    count: Array  # [] decisions of the episode so far


@part
class StagesController:
    """Each of `stages` acts for its number of `decisions`; the last one acts to the end.

    A stage of 0 decisions is skipped. A stage that is not acting keeps its state. Metrics that the
    acting stage lacks are NaN.
    """

    stages: Mapping[str, Controller]  # in order
    decisions: tuple[Natural, ...] = ()  # of every stage but the last
    of_run: bool = False  # counts decisions of the run; without a run, the last stage acts

    @property
    def _acting(self) -> tuple[list[str], list[int]]:
        """The stages that are not skipped, and the decisions of all but the last."""
        counts = [n for n in self.decisions if n]
        each = zip(self.stages, (*self.decisions, 1), strict=True)
        return [name for name, n in each if n], counts

    def init(self, spec: Spec) -> StagesState:
        """The initial states of all stages."""
        each = {name: self.stages[name].init(spec) for name in self._acting[0]}
        return StagesState(each, jnp.zeros((), jnp.int32))

    def act(
        self, params: Params, state: StagesState, obs: Array, key: Array
    ) -> tuple[Array, StagesState, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""

        def branch_of(name: str, missing: Mapping[str, Array]) -> Any:
            def act(each: dict[str, Any]) -> tuple[Array, dict[str, Any], dict[str, Array]]:
                u, after, metrics = self.stages[name].act(params, each[name], obs, key)
                return u, {**each, name: after}, {**missing, **metrics}

            return act

        names, decisions = self._acting
        shapes: dict[str, Any] = {}
        for name in names:
            shapes |= jax.eval_shape(branch_of(name, {}), state.each)[2]
        nothing = {name: jnp.full(m.shape, jnp.nan, m.dtype) for name, m in shapes.items()}
        branches = [branch_of(name, nothing) for name in names]
        ends = jnp.cumsum(jnp.array(decisions, jnp.int32))
        count = params.decisions if self.of_run else state.count
        stage = jnp.sum((jnp.inf if count is None else count) >= ends)
        u, each, metrics = jax.lax.switch(stage, branches, state.each)
        return u, StagesState(each, state.count + 1), metrics

    def greedy(self) -> "StagesController":
        """The same stages without exploration."""
        return replace(self, stages={name: each.greedy() for name, each in self.stages.items()})
