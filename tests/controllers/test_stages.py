"""One controller after the other within an episode."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.controllers.stages import StagesController
from hybrid_rl.training.metrics import masked_mean
from hybrid_rl.types import Params, Spec

SPEC = Spec(obs=1, act=1, dt=0.1)


@dataclass(frozen=True)
class Counts:
    """The action is the number of its own decisions plus `first`; a metric of its name."""

    name: str
    first: float

    def init(self, spec: Spec) -> Array:
        return jnp.float32(self.first)

    def act(self, params: Any, state: Array, obs: Array, key: Array) -> tuple:
        return state[None], state + 1, {f"planner/{self.name}": state, "planner/both": -state}

    def greedy(self) -> "Counts":
        return Counts(self.name, -self.first)


STAGES = StagesController({"a": Counts("a", 0.0), "b": Counts("b", 10.0)}, (3,))


def follow(controller: Any, decisions: int) -> tuple[list, dict[str, Array]]:
    """Actions [T] and metrics [T]."""

    def decide(state: Any, key: Array) -> tuple:
        u, state, metrics = controller.act(Params(), state, jnp.zeros(1), key)
        return state, (u[0], metrics)

    keys = jax.random.split(jax.random.key(0), decisions)
    u, metrics = jax.lax.scan(decide, controller.init(SPEC), keys)[1]
    return u.tolist(), metrics


def test_each_stage_acts_for_its_decisions_and_the_last_to_the_end() -> None:
    """Three decisions of a, then b, whose state starts when it starts to act."""
    assert follow(STAGES, 6)[0] == [0, 1, 2, 10, 11, 12]
    assert follow(STAGES.greedy(), 5)[0] == [0, 1, 2, -10, -9]
    assert follow(StagesController({"a": Counts("a", 4.0)}), 2)[0] == [4, 5]


def test_a_metric_of_another_stage_does_not_apply() -> None:
    """It is NaN, which a mean over environments omits; metrics of all stages are numbers."""
    metrics = follow(STAGES, 4)[1]
    np.testing.assert_array_equal(metrics["planner/both"], [0, -1, -2, -10])
    np.testing.assert_array_equal(metrics["planner/a"], [0, 1, 2, np.nan])
    np.testing.assert_array_equal(metrics["planner/b"], [np.nan, np.nan, np.nan, 10])
    means = masked_mean(metrics, True, sparse=True)
    assert (float(means["planner/a"]), float(means["planner/b"])) == (1, 10)
    assert np.isinf(masked_mean({"x": jnp.array([1.0, jnp.inf])}, True, sparse=True)["x"])


def test_a_stage_of_no_decisions_is_skipped() -> None:
    """Its state is not made, and its metrics do not appear."""
    actions, metrics = follow(StagesController(STAGES.stages, (0,)), 3)
    assert actions == [10, 11, 12]
    assert sorted(metrics) == ["planner/b", "planner/both"]


def test_stages_of_a_run_count_its_decisions_and_end_with_it() -> None:
    """Whatever the episode; without a run, as in an evaluation, the last stage acts."""
    stages, key = StagesController(STAGES.stages, (3,), of_run=True), jax.random.key(0)
    actions = [
        float(stages.act(Params(decisions=now), stages.init(SPEC), jnp.zeros(1), key)[0][0])
        for now in (*map(jnp.int32, (0, 2, 3, 100)), None)
    ]
    assert actions == [0, 0, 10, 10, 10]
