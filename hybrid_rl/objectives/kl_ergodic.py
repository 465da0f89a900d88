"""J = -D(p || q) - b outside: spend time at s in proportion to how much there is to learn there.

D and q as in core.ergodic; the N points are drawn anew at every decision, q counts the path and
the last M states. `JensenErgodic` replaces log q by its lower bound (thesis eq. 6.17-6.18),

    J = -1/2 mean_t sum_i p_i |s_i - x_t|^2_(1/Sigma),   J_x = -(x_t - E_p[s]) / Sigma / (T+1),

which knows nothing of p but its mean: it leads there and stays. It explores only as p moves.
Source: thesis section 6.1, and 6.2.4 for the bound, whose printed form lacks 1/T.
"""

from dataclasses import dataclass
from math import prod
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import ergodic
from hybrid_rl.types import Params, Path, Spec, Target


class Seen(NamedTuple):
    """What the measure remembers of an episode, and draws at a decision."""

    x: Array  # [M, v] the last states, a ring
    count: Array  # [] decisions so far
    log_past: Array  # [N] log sum of their Gaussians at the points
    points: ergodic.Points  # [N]


@dataclass(frozen=True)
class KLErgodic:
    """Minus the KL-ergodic measure of `coordinates` of the planning state in a box.

    Raises:
        ValueError: for a box, sizes or a variance that make no search.
    """

    target: Target
    coordinates: tuple[int, ...] = (0,)  # of the planning state, [v]
    low: tuple[float, ...] = (-1.0,)
    high: tuple[float, ...] = (1.0,)
    samples: int = 100  # N
    variance: tuple[float, ...] = (0.1,)  # diagonal of Sigma: one for all, or [v]
    memory: int = 0  # M [decisions]
    floor: float = 0.0  # added to q [1/volume of s]: what lies further away pulls less
    barrier: float = 0.0  # b [1/length^2]

    def __post_init__(self) -> None:
        """Check the fields."""
        for name in ("coordinates", "low", "high", "variance"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        ergodic.box("exploration", self.coordinates, self.low, self.high)
        if self.samples < 1 or self.memory < 0:
            raise ValueError("exploration: samples must be 1 or more, memory 0 or more")
        if len(self.variance) not in (1, len(self.low)) or min(self.variance) <= 0:
            raise ValueError(f"exploration.variance={list(self.variance)}: 1 or v numbers above 0")
        if self.floor < 0 or self.barrier < 0:
            raise ValueError("exploration: floor and barrier must be 0 or more")

    @property
    def _variance(self) -> Array:
        """[v]."""
        return jnp.broadcast_to(jnp.array(self.variance), (len(self.low),))

    @property
    def volume(self) -> float:
        """Of the box."""
        sides = [b - a for a, b in zip(self.low, self.high, strict=True)]
        return prod(sides)

    def begin(self, spec: Spec) -> Seen:
        """Nothing seen."""
        v, n = len(self.low), self.samples
        points = ergodic.Points(jnp.zeros((n, v)), jnp.full(n, -jnp.log(n)))
        return Seen(jnp.zeros((self.memory, v)), jnp.zeros(()), jnp.full(n, -1e30), points)

    def look(self, params: Params, memory: Seen, x: Array, key: Array) -> Seen:
        """Draw the points, weigh p and the past at them, and remember x. The key is consumed."""
        s = ergodic.uniform(self.low, self.high, self.samples, key)
        log_p = jax.vmap(self.target.log_density, (None, 0))(params, s)
        points = ergodic.Points(s, jax.nn.log_softmax(log_p))
        if self.memory == 0:
            return memory._replace(count=memory.count + 1, points=points)
        counted = jnp.arange(self.memory) < memory.count
        past = ergodic.log_sum(s, memory.x, self._variance, counted)
        at = (memory.count % self.memory).astype(jnp.int32)
        kept = memory.x.at[at].set(x[jnp.array(self.coordinates)])
        return Seen(kept, memory.count + 1, past, points)

    def log_average(self, memory: Seen, path: Path) -> Array:
        """log q [N] at the points, of the past and `path` together."""
        now = ergodic.log_sum(memory.points.s, self._of(path), self._variance)
        count = jnp.minimum(memory.count - 1, self.memory) + len(path.x)
        log_q = jnp.logaddexp(memory.log_past, now) - jnp.log(count)
        return jnp.logaddexp(log_q, jnp.log(self.floor)) if self.floor else log_q

    def value(self, params: Params, memory: Seen, path: Path) -> Array:
        """J [] [nat]."""
        apart = ergodic.divergence(memory.points, self.log_average(memory, path), self.volume)
        return -apart - self.barrier * ergodic.outside(self._of(path), self.low, self.high)

    def _of(self, path: Path) -> Array:
        """The path's search states [T+1, v]."""
        return path.x[:, jnp.array(self.coordinates)]


@dataclass(frozen=True)
class JensenErgodic(KLErgodic):
    """The bound instead of the measure: leads to the mean of p, and no further."""

    def value(self, params: Params, memory: Seen, path: Path) -> Array:
        """J [] [nat], up to a constant."""
        x = self._of(path)
        near = -ergodic.spread(memory.points, x, self._variance)
        return near - self.barrier * ergodic.outside(x, self.low, self.high)
