"""Protocols of beliefs, which measurements update."""

from typing import Protocol

from jax import Array

from hybrid_rl.protocols.contract import gives
from hybrid_rl.types import PyTree, Spec


class Belief(Protocol):
    """A distribution over an unknown function, updated recursively by measurements y at s."""

    @gives("key, spec -> state")
    def init(self, key: Array, spec: Spec) -> PyTree:
        """The belief before any measurement."""

    def add(self, state: PyTree, s: Array, y: Array, key: Array) -> PyTree:
        """The belief after y [] was measured at s [v]."""

    def predict(self, state: PyTree, s: Array) -> tuple[Array, Array]:
        """Mean and standard deviation [] of the function at s [v]."""

    def loss(self, state: PyTree, s: Array, y: Array) -> Array:
        """Negative log-likelihood [] of y [] at s [v], before it is added."""

    def report(self, state: PyTree) -> dict[str, Array]:
        """Metrics, name -> []."""


class InformedBelief(Belief, Protocol):
    """A belief that measures what a measurement would tell it."""

    def information(self, state: PyTree, s: Array) -> Array:
        """The information [] of a measurement at s [v], up to a factor."""

    def gain(self, state: PyTree, s: Array) -> Array:
        """The entropy [nat] that a measurement at s [v] is expected to remove."""

    def gain_along(self, state: PyTree, path: Array) -> Array:
        """The entropy [nat] that measurements on path [T, v] remove, if each is the likelier."""

    def informed(self, state: PyTree) -> Array:
        """[] bool: whether any measurement distinguished one region from another."""
