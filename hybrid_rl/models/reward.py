"""A network for r(x, u) and the end of episodes (thesis appendix B: two layers of 200)."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.networks import MLP, check
from hybrid_rl.types import Spec


@dataclass(frozen=True)
class RewardNetwork:
    """A reward, and with `ends` the probability that the episode ends.

    Raises:
        ValueError: for invalid widths or activations.
    """

    hidden: tuple[int, ...] = (200, 200)
    activation: str = "relu"
    normalise: bool = True  # states by their running statistics
    ends: bool = False  # also learn where episodes end

    def __post_init__(self) -> None:
        """Check the fields."""
        object.__setattr__(self, "hidden", tuple(self.hidden))
        check("reward", self.hidden, self.activation)

    def _net(self) -> MLP:
        return MLP(self.hidden, 1 + self.ends, self.activation)

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial weights and statistics. The key is consumed."""
        return {
            "weights": self._net().init(key, jnp.zeros(spec.n + spec.act)),
            "state": statistics.init(spec.n),
        }

    def observe(self, params: dict[str, Any], x: Array) -> dict[str, Any]:
        """Parameters with statistics updated by x [B, n]."""
        if not self.normalise:
            return params
        return {**params, "state": statistics.update(params["state"], x)}

    def outcome(self, params: dict[str, Any], x: Array, u: Array) -> tuple[Array, Array]:
        """The reward [] of u [m] at x [n], and the logit [] of the episode ending there."""
        inputs = jnp.concatenate([statistics.normalise(params["state"], x), u])
        out: Any = self._net().apply(params["weights"], inputs)
        return out[0], out[1] if self.ends else -jnp.inf

    def loss(
        self, params: dict[str, Any], x: Array, u: Array, target: Array, ended: Array
    ) -> Array:
        """Half the squared error [] against target [], and the cross entropy of `ended` []."""
        r, logit = self.outcome(params, x, u)
        error = 0.5 * (target - r) ** 2
        return error + jax.nn.softplus(logit) - ended * logit if self.ends else error
