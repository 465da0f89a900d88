"""J = -vol sum_k Lambda_k (c_k - phi_k)^2 - b outside: the Fourier ergodic metric.

c_k averages over the path and the earlier states of the episode, of which each decision forgets a
share 1 - f: f = 0 counts the path alone, as the thesis prints it. phi_k is estimated at the same N
uniform points as the KL-ergodic measure. The volume of the domain makes J a pure number. See
core.ergodic.
"""

from dataclasses import replace
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import ergodic
from hybrid_rl.core.domain import Box
from hybrid_rl.fields import Count, Fraction, NotNegative, part
from hybrid_rl.protocols import Target
from hybrid_rl.types import Params, Path, Return, Spec


class FourierState(NamedTuple):
    """Statistics of the states of an episode so far."""

    total: Array  # [K^v] sum of F_k over them
    count: Array  # []


@part
class FourierErgodic:
    """Minus the Fourier ergodic metric of a path in a domain."""

    target: Target
    domain: Box
    samples: Count = 1000  # N
    modes: Count = 5  # K for each coordinate
    barrier: NotNegative = 0.0  # b, cost of leaving the domain, in its sides
    share: Fraction = 0.0  # of the uniform density in p; 1: coverage
    forget: Fraction = 1.0  # f, the weight that earlier states keep per decision

    def init(self, spec: Spec) -> FourierState:
        """An empty memory."""
        return FourierState(jnp.zeros(self.modes**self.domain.size), jnp.zeros(()))

    def prepare(
        self, params: Params, memory: FourierState, x: Array, u_before: Array, key: Array
    ) -> tuple[Return, FourierState]:
        """J of a path, with phi estimated at new points; the memory includes x [n]."""
        s = self.domain.sample(self.samples, key)
        log_p = jax.vmap(self.target.log_density, (None, 0))(params, s)
        p = (1 - self.share) * jax.nn.softmax(log_p) + self.share / self.samples
        phi = p @ self.features(s)
        weights = ergodic.fourier_decay(self.domain.size, self.modes)

        def value(path: Path) -> Array:
            apart = ergodic.fourier_metric(self.average(memory, path), phi, weights)
            outside = self.domain.outside(self.domain.of(path.x))
            return -self.domain.volume * apart - self.barrier * outside

        now = self.features(self.domain.of(x)[None])[0]
        return value, FourierState(
            self.forget * (memory.total + now), self.forget * (memory.count + 1)
        )

    def covered(
        self, params: Params, memory: FourierState, x: Array, key: Array
    ) -> dict[str, Array]:
        """The metric of the states in `memory` and x [n], with phi at the points of `prepare`."""
        value = replace(self, barrier=0.0).prepare(params, memory, x, x, key)[0]
        return {"exploration/fourier_metric": -value(Path(x[None], x[None, :0]))}

    def features(self, s: Array) -> Array:
        """F_k [M, K^v] at s [M, v]."""
        return ergodic.cosines(s, self.domain.low, self.domain.high, self.modes)

    def average(self, memory: FourierState, path: Path) -> Array:
        """c_k [K^v] of the states in memory and in `path`."""
        total = memory.total + jnp.sum(self.features(self.domain.of(path.x)), 0)
        return total / (memory.count + len(path.x))
