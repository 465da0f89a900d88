"""J = -D(p || q) - b outside: spend time at s in proportion to the target p(s).

D and q as in core.ergodic; N points are drawn at every decision, q averages over the path and the
last M states. `JensenErgodic` replaces log q by its lower bound (thesis eq. 6.17-6.18),

    J = -1/2 mean_t sum_i p_i |s_i - x_t|^2_(1/Sigma),   J_x = -(x_t - E_p[s]) / Sigma / (T+1),

which depends on p only through its mean: paths go to the mean and stay, unless p changes.
Source: thesis section 6.1, and 6.2.4 for the bound, whose printed form lacks 1/T.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import ergodic
from hybrid_rl.core.domain import Box
from hybrid_rl.fields import Count, Fraction, Natural, NotNegative, Positive, part
from hybrid_rl.protocols import Target
from hybrid_rl.types import Params, Path, Return, Spec


class KLState(NamedTuple):
    """The last states of an episode."""

    s: Array  # [M, v] a ring
    count: Array  # [] decisions so far


@part
class KLErgodic:
    """Minus the KL-ergodic measure of a path in a domain."""

    target: Target
    domain: Box
    samples: Count = 100  # N
    variance: tuple[Positive, ...] = (0.1,)  # diagonal of Sigma: one for all, or [v]
    memory: Natural = 0  # M [decisions]
    floor: NotNegative = 0.0  # added to q [uniform density]: distant regions attract less
    barrier: NotNegative = 0.0  # b, cost of leaving the domain, in its sides
    share: Fraction = 0.0  # of the uniform density in p; 1: coverage

    @property
    def _variance(self) -> Array:
        """The diagonal of Sigma [v]."""
        return jnp.broadcast_to(jnp.array(self.variance), (self.domain.size,))

    def init(self, spec: Spec) -> KLState:
        """An empty memory."""
        return KLState(jnp.zeros((self.memory, self.domain.size)), jnp.zeros(()))

    def prepare(
        self, params: Params, memory: KLState, x: Array, u_before: Array, key: Array
    ) -> tuple[Return, KLState]:
        """J [nat] of a path, at newly drawn points; the memory then includes x [n]."""
        value = self.measure(self._points(params, key), memory)
        after = memory._replace(count=memory.count + 1)
        if self.memory:
            slot = (memory.count % self.memory).astype(jnp.int32)
            after = after._replace(s=memory.s.at[slot].set(self.domain.of(x)))
        return value, after

    def _points(self, params: Params, key: Array) -> ergodic.Points:
        """The points at which p and q are compared. The key is consumed."""
        s = self.domain.sample(self.samples, key)
        log_p = jax.vmap(self.target.log_density, (None, 0))(params, s)
        return ergodic.Points(s, ergodic.log_weights(log_p, self.share))

    def covered(self, params: Params, memory: KLState, x: Array, key: Array) -> dict[str, Array]:
        """D [nat] of the states in `memory` and x [n], at the points that `prepare` draws."""
        if not self.memory:
            return {}
        measure = KLErgodic.measure(replace(self, barrier=0.0), self._points(params, key), memory)
        return {"exploration/divergence": -measure(Path(x[None], x[None, :0]))}

    def measure(self, points: ergodic.Points, memory: KLState) -> Return:
        """J of a path that follows the states in `memory`, with p and q compared at `points`."""
        log_past = jnp.full(len(points.s), -1e30)
        if self.memory:
            filled = jnp.arange(self.memory) < memory.count
            log_past = ergodic.log_sum(points.s, memory.s, self._variance, filled)

        def value(path: Path) -> Array:
            x = self.domain.of(path.x)
            log_path = ergodic.log_sum(points.s, x, self._variance)
            count = jnp.minimum(memory.count, self.memory) + len(x)
            log_q = jnp.logaddexp(log_past, log_path) - jnp.log(count)
            if self.floor:
                log_q = jnp.logaddexp(log_q, jnp.log(self.floor / self.domain.volume))
            apart = ergodic.divergence(points, log_q, self.domain.volume)
            return -apart - self.barrier * self.domain.outside(x)

        return value


@dataclass(frozen=True)
class JensenErgodic(KLErgodic):
    """The lower bound instead of the measure: leads to the mean of p."""

    def measure(self, points: ergodic.Points, memory: KLState) -> Return:
        """J [nat] of a path, up to a constant."""

        def value(path: Path) -> Array:
            x = self.domain.of(path.x)
            near = -ergodic.mean_distance(points, x, self._variance)
            return near - self.barrier * self.domain.outside(x)

        return value
