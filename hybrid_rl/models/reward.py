"""A network for r(x, u) and the end of episodes (thesis appendix B: two layers of 200).

    r = m + s f(x, u)

with m = 0 and s = 1, or with `scale` the running mean and standard deviation of the rewards, so
that their error counts in units of s, as a model's errors count in running standard deviations.
"""

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
    layer_norm: bool = False  # of every hidden layer, before its activation
    scale: bool = False  # targets by their running statistics

    def __post_init__(self) -> None:
        """Check the fields."""
        object.__setattr__(self, "hidden", tuple(self.hidden))
        check("reward", self.hidden, self.activation)

    def _net(self) -> MLP:
        return MLP(self.hidden, 1 + self.ends, self.activation, self.layer_norm)

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial weights and statistics. The key is consumed."""
        params = {
            "weights": self._net().init(key, jnp.zeros(spec.n + spec.act)),
            "state": statistics.init(spec.n),
        }
        return {**params, "target": statistics.init(1)} if self.scale else params

    def observe(self, params: dict[str, Any], x: Array) -> dict[str, Any]:
        """Parameters with statistics updated by x [B, n]."""
        if not self.normalise:
            return params
        return {**params, "state": statistics.update(params["state"], x)}

    def observe_targets(self, params: dict[str, Any], target: Array) -> dict[str, Any]:
        """Parameters with statistics updated by targets [B] of the reward."""
        if not self.scale:
            return params
        return {**params, "target": statistics.update(params["target"], target[:, None])}

    def outcome(self, params: dict[str, Any], x: Array, u: Array) -> tuple[Array, Array]:
        """The reward [] of u [m] at x [n], and the logit [] of the episode ending there."""
        inputs = jnp.concatenate([statistics.normalise(params["state"], x), u])
        out: Any = self._net().apply(params["weights"], inputs)
        r = statistics.denormalise(params["target"], out[:1])[0] if self.scale else out[0]
        return r, out[1] if self.ends else -jnp.inf

    def loss(
        self, params: dict[str, Any], x: Array, u: Array, target: Array, ended: Array
    ) -> Array:
        """Half the squared error [] against target [], and the cross entropy of `ended` [].

        With `scale`, the error is in running standard deviations of the targets.
        """
        r, logit = self.outcome(params, x, u)
        error = target - r
        if self.scale:
            error = error / params["target"].scale[0]
        error = 0.5 * error**2
        return error + jax.nn.softplus(logit) - ended * logit if self.ends else error
