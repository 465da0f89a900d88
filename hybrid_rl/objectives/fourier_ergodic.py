"""J = -sum_k Lambda_k (c_k - phi_k)^2 - b outside: Fourier's ergodic metric, to compare with.

c_k counts the path and all that came before it in the episode; phi_k is estimated at the same
N uniform points as the KL-ergodic measure. See core.fourier.
"""

from dataclasses import dataclass
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import ergodic, fourier
from hybrid_rl.types import Params, Path, Spec, Target


class Heard(NamedTuple):
    """What the metric remembers of an episode, and draws at a decision."""

    past: Array  # [K^v] sum of F_k over the states before this one
    now: Array  # [K^v] F_k of this state
    count: Array  # [] decisions so far
    phi: Array  # [K^v]


@dataclass(frozen=True)
class FourierErgodic:
    """Minus the ergodic metric of `coordinates` of the planning state in a box.

    Raises:
        ValueError: for a box or sizes that make no search.
    """

    target: Target
    coordinates: tuple[int, ...] = (0,)  # of the planning state, [v]
    low: tuple[float, ...] = (-1.0,)
    high: tuple[float, ...] = (1.0,)
    samples: int = 1000  # N
    modes: int = 5  # K, a coordinate
    barrier: float = 0.0  # b [1/length^2]

    def __post_init__(self) -> None:
        """Check the fields."""
        for name in ("coordinates", "low", "high"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        ergodic.box("exploration", self.coordinates, self.low, self.high)
        if self.samples < 1 or self.modes < 1 or self.barrier < 0:
            raise ValueError("exploration: samples and modes 1 or more, barrier 0 or more")

    def begin(self, spec: Spec) -> Heard:
        """Nothing seen."""
        none = jnp.zeros(self.modes ** len(self.low))
        return Heard(none, none, jnp.zeros(()), none)

    def look(self, params: Params, memory: Heard, x: Array, key: Array) -> Heard:
        """Estimate phi at points drawn anew, and remember x. The key is consumed."""
        s = ergodic.uniform(self.low, self.high, self.samples, key)
        p = jax.nn.softmax(jax.vmap(self.target.log_density, (None, 0))(params, s))
        now = self.features(x[None, jnp.array(self.coordinates)])[0]
        return Heard(memory.past + memory.now, now, memory.count + 1, p @ self.features(s))

    def features(self, s: Array) -> Array:
        """F_k [M, K^v] at s [M, v]."""
        return fourier.features(s, self.low, self.high, self.modes)

    def average(self, memory: Heard, path: Path) -> Array:
        """c_k [K^v] of the past and `path` together."""
        total = memory.past + jnp.sum(self.features(self._of(path)), 0)
        return total / (memory.count - 1 + len(path.x))

    def value(self, params: Params, memory: Heard, path: Path) -> Array:
        """J []."""
        weights = fourier.decay(len(self.low), self.modes)
        apart = fourier.metric(self.average(memory, path), memory.phi, weights)
        return -apart - self.barrier * ergodic.outside(self._of(path), self.low, self.high)

    def _of(self, path: Path) -> Array:
        """The path's search states [T+1, v]."""
        return path.x[:, jnp.array(self.coordinates)]
