"""J = sum_i w_i d_i^k J_i, with k the decisions of the episode so far."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.protocols import Objective
from hybrid_rl.types import Params, Path, Return, Spec


class SumState(NamedTuple):
    """The memories of all terms."""

    terms: dict[str, Any]
    count: Array  # [] decisions of the episode so far


@dataclass(frozen=True)
class WeightedSum:
    """Several objectives, each with a weight and the factor by which it decays per decision.

    Sampling planners need a sum over time: all terms must be one, and no weight may decay.
    """

    terms: Mapping[str, Objective]
    weights: Mapping[str, float]
    decays: Mapping[str, float] = field(default_factory=dict)  # d_i per decision; absent: 1

    def __post_init__(self) -> None:
        names = ", ".join(self.terms)
        if self.weights.keys() != self.terms.keys() or not self.decays.keys() <= self.terms.keys():
            raise ValueError(f"objective: weights need {names}; decays are of some of them")

    def init(self, spec: Spec) -> SumState:
        """The initial memories of all terms."""
        terms = {name: term.init(spec) for name, term in self.terms.items()}
        return SumState(terms, jnp.zeros((), jnp.int32))

    def prepare(
        self, params: Params, memory: SumState, x: Array, u_before: Array, key: Array
    ) -> tuple[Return, SumState]:
        """J of a path, and the memories of all terms. The key is consumed."""
        returns, terms = {}, {}
        for (name, term), k in zip(
            self.terms.items(), jax.random.split(key, len(self.terms)), strict=True
        ):
            returns[name], terms[name] = term.prepare(params, memory.terms[name], x, u_before, k)
        weights = {
            name: weight * self.decays.get(name, 1.0) ** memory.count
            for name, weight in self.weights.items()
        }

        def value(path: Path) -> Array:
            each = [weights[name] * returns[name](path) for name in returns]
            return sum(each[1:], each[0])

        return value, SumState(terms, memory.count + 1)

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1] along path, x [T+1, n] and u [T, m]."""
        if any(decay != 1 for decay in self.decays.values()):
            raise ValueError("objective.decays: a planner that samples needs constant weights")
        terms: Mapping[str, Any] = self.terms
        each = [self.weights[t] * term.reward_to_go(params, path) for t, term in terms.items()]
        return sum(each[1:], each[0])
