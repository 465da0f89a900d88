"""p(y = 1 | s) = sigmoid(slope f(s)): the probability of a binary measurement, by support vectors.

    mean p(s),   std sqrt(p (1 - p)),   loss -log p(y | s)
    transition information  p (1 - p)
    Fisher information      p (1 - p) |slope df/ds|^2, its trace
    entropy                 -p log p - (1 - p) log(1 - p)

Before the first 1, f = -1 everywhere. The determinant of Fisher's information, which the thesis
prints, is 0 for one measurement of two or more coordinates. A fixed slope replaces Platt's fit,
which degenerates where labels separate. The soft-margin machine is solved by sequential minimal
optimisation in fixed arrays:

    f(s) = sum_i v_i k(s, s_i) + b,   k = exp(-|s - s'|^2 / (2 l^2)),   y_i = -1 or 1
    max_v  sum_i y_i v_i - 1/2 v' K v,   sum_i v_i = 0,   0 <= y_i v_i <= C w_i

One iteration changes the pair of duals (i, j) that violates optimality most, to second order:

    E = y - K v,   i = argmax {E : v can rise}
    j = argmax {(E_i - E_j)^2 / (2 - 2 k_ij) : v can fall, E_j < E_i}
    v_i += t,  v_j -= t,   t = (E_i - E_j) / (2 - 2 k_ij), up to the bounds
    b = (max {E : v can rise} + min {E : v can fall}) / 2

A new point has v = 0, which keeps all constraints, so that the machine goes on from where it was.
Source: thesis section 5.3; Fan, Chen and Lin 2005, Working Set Selection Using Second Order
Information for Training Support Vector Machines, as in LIBSVM; here with v_i = y_i alpha_i.
"""

from typing import Literal, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Count, NotNegative, Positive, part
from hybrid_rl.types import Spec


class Machine(NamedTuple):
    """Up to C labelled points and the solution for them."""

    s: Array  # [C, d]
    label: Array  # [C] -1 or 1; 0 where there is no point
    weight: Array  # [C] w: how often the point counts
    dual: Array  # [C] v
    output: Array  # [C] K v
    count: Array  # [] points


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
        zeros, none = jnp.zeros(self.capacity), jnp.zeros((), jnp.int32)
        s = jnp.zeros((self.capacity, self.size))
        return Machine(s, zeros, zeros, zeros, zeros, none)

    def add(self, state: Machine, s: Array, y: Array, key: Array) -> Machine:
        """The belief after y [], 0 or 1, was measured at s [d]; the key is not used."""
        return self.optimised(self.joined(state, s, jnp.where(y > 0.5, 1.0, -1.0)))

    def joined(self, machine: Machine, s: Array, label: Array) -> Machine:
        """The machine with a point s [d] of `label` [], not yet optimised.

        A point closer than `apart` to one with the same label adds 1 to the weight of that one. In
        a full machine every point adds to the nearest of its label, and is dropped without one.
        """
        distance = jnp.sqrt(jnp.sum((machine.s - s[None]) ** 2, -1))
        distance = jnp.where(machine.label == label, distance, jnp.inf)
        nearest = jnp.argmin(distance)
        full = machine.count >= self.capacity
        joins = jnp.isfinite(distance[nearest]) & (full | (distance[nearest] < self.apart))
        enters = ~joins & ~full
        slot = jnp.where(joins, nearest, jnp.minimum(machine.count, self.capacity - 1))
        output = self.kernel(s, machine.s) @ machine.dual
        return Machine(
            machine.s.at[slot].set(jnp.where(enters, s, machine.s[slot])),
            machine.label.at[slot].set(jnp.where(enters, label, machine.label[slot])),
            machine.weight.at[slot].add(jnp.where(enters | joins, 1.0, 0.0)),
            machine.dual,
            machine.output.at[slot].set(jnp.where(enters, output, machine.output[slot])),
            machine.count + enters.astype(jnp.int32),
        )

    def optimised(self, machine: Machine) -> Machine:
        """The machine after `iterations` on pairs of duals."""

        def one(_: Array, machine: Machine) -> Machine:
            rising, falling, low, high = self._errors(machine)
            i = jnp.argmax(rising)
            k_i = self.kernel(machine.s[i], machine.s)
            curvature = jnp.maximum(2 - 2 * k_i, 1e-6)
            gap = jnp.where(jnp.isfinite(falling), rising[i] - falling, -jnp.inf)
            j = jnp.argmax(jnp.where(gap > 0, gap**2 / curvature, -jnp.inf))
            step = jnp.minimum(gap[j] / curvature[j], high[i] - machine.dual[i])
            step = jnp.minimum(step, machine.dual[j] - low[j])
            step = jnp.where(jnp.isfinite(rising[i]) & (gap[j] > 0), step, 0.0)
            k_j = self.kernel(machine.s[j], machine.s)
            return machine._replace(
                dual=machine.dual.at[i].add(step).at[j].add(-step),
                output=machine.output + step * (k_i - k_j),
            )

        return jax.lax.fori_loop(0, self.iterations, one, machine)

    def kernel(self, s: Array, points: Array) -> Array:
        """k [N] of s [d] with points [N, d]."""
        return jnp.exp(-0.5 * jnp.sum((points - s[None]) ** 2, -1) / self.length**2)

    def _errors(self, machine: Machine) -> tuple[Array, Array, Array, Array]:
        """E [C] where v can rise, else -inf; where it can fall, else inf; least, greatest v [C]."""
        bound = self.cost * machine.weight
        low = jnp.where(machine.label < 0, -bound, 0.0)
        high = jnp.where(machine.label > 0, bound, 0.0)
        error = machine.label - machine.output
        rising = jnp.where(machine.dual < high, error, -jnp.inf)
        falling = jnp.where(machine.dual > low, error, jnp.inf)
        return rising, falling, low, high

    def decision(self, state: Machine, s: Array) -> Array:
        """f(s) [], positive where the measurement is more likely 1."""
        rising, falling, _, _ = self._errors(state)
        up, down = jnp.max(rising), jnp.min(falling)  # one of them is infinite with one label alone
        up, down = jnp.where(jnp.isfinite(up), up, down), jnp.where(jnp.isfinite(down), down, up)
        f = self.kernel(s, state.s) @ state.dual + (up + down) / 2
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
        """The number of points, whether the memory is full, the gap of optimality.

        It is max E where v can rise less min E where it can fall: 0 where the duals are optimal.
        """
        rising, falling, _, _ = self._errors(state)
        gap = jnp.max(rising) - jnp.min(falling)
        return {
            "belief/points": state.count.astype(jnp.float32),
            "belief/full": (state.count >= self.capacity).astype(jnp.float32),
            "belief/gap": jnp.where(jnp.isfinite(gap), jnp.maximum(gap, 0.0), 0.0),
        }
