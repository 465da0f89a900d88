"""Q(x, u): the minimum of an ensemble of action values (Fujimoto et al. 2018, eq. 10)."""

from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.networks import MLP, check, ensemble_apply, ensemble_init
from hybrid_rl.types import Spec


@dataclass(frozen=True)
class EnsembleQ:
    """`members` independent action-value networks.

    Raises:
        ValueError: for invalid widths, activations or counts.
    """

    hidden: tuple[int, ...] = (256, 256)
    activation: str = "relu"
    members: int = 2
    layer_norm: bool = False  # keeps many updates per decision stable (Hiraoka et al. 2022)

    def __post_init__(self) -> None:
        """Check the fields."""
        object.__setattr__(self, "hidden", tuple(self.hidden))
        check("critic", self.hidden, self.activation)
        if self.members < 1:
            raise ValueError(f"critic.members={self.members}: must be at least 1")

    def _net(self) -> MLP:
        return MLP(self.hidden, 1, self.activation, self.layer_norm)

    def init(self, key: Array, spec: Spec) -> Any:
        """Initial parameters, members on axis 0. The key is consumed."""
        return ensemble_init(self._net(), key, self.members, jnp.zeros(spec.n + spec.act))

    def all(self, params: Any, x: Array, u: Array) -> Array:
        """Q of every member [members, ...] at x [..., n] and u [..., m]."""
        return ensemble_apply(self._net(), params, jnp.concatenate([x, u], -1))[..., 0]

    def value(self, params: Any, x: Array, u: Array) -> Array:
        """The minimum of Q [...] over the members."""
        return self.all(params, x, u).min(0)
