"""p(y = 1 | s) = sigmoid(slope f(s)): the probability of a binary measurement, by support vectors.

    mean p(s),   std sqrt(p (1 - p)),   loss -log p(y | s)
    transition information  p (1 - p)
    Fisher information      p (1 - p) |slope df/ds|^2, its trace
    entropy                 -p log p - (1 - p) log(1 - p)

Before the first 1, f = -1 everywhere. The determinant of Fisher's information, which the thesis
prints, is 0 for one measurement of two or more coordinates. A fixed slope replaces Platt's fit,
which degenerates where labels separate. Source: thesis section 5.3; core.support_vectors.
"""

from typing import Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import support_vectors as svm
from hybrid_rl.core.support_vectors import Machine
from hybrid_rl.fields import Count, NotNegative, Positive, part
from hybrid_rl.types import Spec


@part
class SupportVectors:
    """A belief about the probability that a binary measurement is 1.

    A full memory adds weight to the nearest measurement instead of a point (`belief/full` is 1).
    """

    size: Count = 2  # d, coordinates of s
    capacity: Count = 512  # measurements that are further apart than `apart`
    length: Positive = 0.08  # l, in units of s
    cost: Positive = 10.0  # C
    slope: Positive = 3.0  # of the sigmoid
    apart: NotNegative = 0.01  # in units of s
    iterations: Count = 60  # of sequential minimal optimisation, per measurement
    measure: Literal["transition", "fisher"] = "transition"

    def init(self, key: Array, spec: Spec) -> Machine:
        """The belief before any measurement; the key is not used."""
        return svm.begin(self.capacity, self.size)

    def add(self, state: Machine, s: Array, y: Array, key: Array) -> Machine:
        """The belief after y [], 0 or 1, was measured at s [d]; the key is not used."""
        label = jnp.where(y > 0.5, 1.0, -1.0)
        state = svm.add(state, s, label, self.length, self.apart)
        return svm.optimise(state, self.iterations, self.length, self.cost)

    def decision(self, state: Machine, s: Array) -> Array:
        """f(s) [], positive where the measurement is more likely 1."""
        f = svm.decision(state, s, self.length, self.cost)
        return jnp.where(state.count > 0, f, -1.0)

    def predict(self, state: Machine, s: Array) -> tuple[Array, Array]:
        """p(y = 1) and the standard deviation [] of y at s [d]."""
        p = jax.nn.sigmoid(self.slope * self.decision(state, s))
        return p, jnp.sqrt(p * (1 - p))

    def loss(self, state: Machine, s: Array, y: Array) -> Array:
        """-log p(y | s) [nat] at s [d], before y [] is added."""
        logit = self.slope * self.decision(state, s)
        return jax.nn.softplus(logit) - y * logit

    def information(self, state: Machine, s: Array) -> Array:
        """The information [] of a measurement at s [d], by `measure`."""
        p, _ = self.predict(state, s)
        if self.measure == "transition":
            return p * (1 - p)
        slope = self.slope * jax.grad(lambda s: self.decision(state, s))(s)
        return p * (1 - p) * jnp.sum(slope**2)

    def gain(self, state: Machine, s: Array) -> Array:
        """The entropy [nat] of a measurement at s [d]."""
        logit = self.slope * self.decision(state, s)
        p = jax.nn.sigmoid(logit)
        return p * jax.nn.softplus(-logit) + (1 - p) * jax.nn.softplus(logit)

    def gain_along(self, state: Machine, path: Array) -> Array:
        """The entropy [nat] [] of the measurements on path [T, d]: each of them removes its own."""
        return jnp.sum(jax.vmap(self.gain, (None, 0))(state, path))

    def informed(self, state: Machine) -> Array:
        """[] bool: whether any measurement was 1."""
        return jnp.any(state.label > 0)

    def report(self, state: Machine) -> dict[str, Array]:
        """The number of points, whether the memory is full, the gap of optimality."""
        return {
            "belief/points": state.count.astype(jnp.float32),
            "belief/full": (state.count >= self.capacity).astype(jnp.float32),
            "belief/gap": svm.gap(state, self.cost),
        }
