"""u = clip(pi(x) + e): a policy, and noise beside it.

    normal   e ~ level N(0, I)
    uniform  e ~ level U(-1, 1)
    ou       e' = (1 - theta dt) e + level sqrt(dt) N(0, I)       Ornstein and Uhlenbeck's

What ergodic exploration around an equilibrium is compared with (thesis section 6.3.2), and how
deep deterministic policy gradients explore (Lillicrap et al. 2016).
"""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import Params, Policy, Spec

KINDS = ("normal", "uniform", "ou")


class Held(NamedTuple):
    """What goes from one decision to the next."""

    e: Array  # [m]
    dt: Array  # [] [s] of a decision


@dataclass(frozen=True)
class NoisyController:
    """The policy's mean with noise of full actuation's `level`.

    Raises:
        ValueError: for an unknown kind, or numbers out of range.
    """

    policy: Policy
    kind: str = "normal"
    level: float = 0.1  # [u], of ou [u / sqrt(s)]
    theta: float = 0.15  # [1/s] of ou
    decay: int | None = None  # decisions of the run until there is none left; None: it stays

    def __post_init__(self) -> None:
        """Check the fields."""
        if self.kind not in KINDS:
            raise ValueError(f"noisy.kind={self.kind}: choose {', '.join(KINDS)}")
        if self.level < 0 or self.theta < 0:
            raise ValueError("noisy: level and theta must be 0 or more")
        if self.decay is not None and self.decay < 1:
            raise ValueError(f"noisy.decay={self.decay}: must be 1 or more")

    def init(self, spec: Spec) -> Held:
        """No noise yet."""
        return Held(jnp.zeros(spec.act), jnp.float32(spec.dt))

    def act(
        self, params: Params, state: Held, obs: Array, key: Array
    ) -> tuple[Array, Held, dict[str, Array]]:
        """Action [m]. The key is consumed."""
        if self.kind == "uniform":
            e = self.level * jax.random.uniform(key, state.e.shape, minval=-1, maxval=1)
        else:
            e = self.level * jax.random.normal(key, state.e.shape)
        if self.kind == "ou":
            e = (1 - self.theta * state.dt) * state.e + jnp.sqrt(state.dt) * e
        share: Any = 1.0
        if self.decay is not None:
            decisions: Any = params.decisions
            share = jnp.maximum(1 - decisions / self.decay, 0)
        u = jnp.clip(self.policy.mean(params.policy, obs) + share * e, -1, 1)
        return u, state._replace(e=e), {}

    def greedy(self) -> "NoisyController":
        """Without noise."""
        return replace(self, level=0.0, decay=None)
