"""A sum of objectives against its terms."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.objectives.weighted_sum import WeightedSum
from hybrid_rl.types import Params, Path, Spec

SPEC = Spec(obs=2, act=1, dt=0.1)
PATH = Path(jnp.arange(8.0).reshape(4, 2), jnp.ones((3, 1)))


@dataclass(frozen=True)
class Term:
    """J = scale * sum of x_0, plus the number of decisions so far; r_t = scale * x_0."""

    scale: float

    def init(self, spec: Spec) -> Array:
        return jnp.zeros(())

    def prepare(self, params: Any, memory: Array, x: Array, u_before: Array, key: Array) -> tuple:
        return lambda path: self.scale * path.x[:, 0].sum() + memory, memory + 1

    def rewards(self, params: Any, path: Path) -> Array:
        return self.scale * path.x[:-1, 0]

    def reward_to_go(self, params: Any, path: Path) -> Array:
        return jnp.append(jnp.cumsum(self.rewards(params, path)[::-1])[::-1], 0)


def test_a_weighted_sum_adds_its_terms_and_weights_decay() -> None:
    """J = 3 J_a + 2 * 0.5^k J_b after k decisions, each term with its own memory."""
    objective = WeightedSum({"a": Term(1.0), "b": Term(-1.0)}, {"a": 3.0, "b": 2.0}, {"b": 0.5})
    memory, total = objective.init(SPEC), float(PATH.x[:, 0].sum())
    for k in range(3):
        prepared = objective.prepare(Params(), memory, PATH.x[0], PATH.u[0], jax.random.key(k))
        value, memory = prepared
        wanted = 3 * (total + k) + 2 * 0.5**k * (-total + k)
        assert float(value(PATH)) == pytest.approx(wanted)


def test_a_weighted_sum_of_sums_over_time_is_one() -> None:
    """It has returns to go, but not if a weight decays."""
    terms = {"a": Term(1.0), "b": Term(-2.0)}
    objective = WeightedSum(terms, {"a": 3.0, "b": 1.0})
    to_go = objective.reward_to_go(Params(), PATH)
    np.testing.assert_allclose(to_go, Term(1.0).reward_to_go(Params(), PATH))
    with pytest.raises(ValueError, match="needs constant weights"):
        WeightedSum(terms, {"a": 1.0, "b": 1.0}, {"a": 0.9}).reward_to_go(Params(), PATH)
