"""u = tanh(z), z ~ N(mu(x), diag(sigma(x)^2)), from a network with unit weights.

    log sigma = low + (high - low) (1 + tanh(s(x))) / 2

mu and s are the outputs of one network (hybrid_rl.networks.normalised). In a batch that
batch normalises it, elsewhere running statistics do. Source: the policy of FlashSAC (Kim et al.
2026), with its width, its two blocks and its bounds.
"""

from typing import Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.squashing import Squashed, sampled
from hybrid_rl.fields import part
from hybrid_rl.networks import normalised
from hybrid_rl.networks.normalised import Blocks, NormalisedNet
from hybrid_rl.types import Spec


@part
class UnitGaussian(Squashed):
    """A stochastic policy on [-1, 1]^m."""

    hidden: Blocks = (128, 128)  # the width, once for each residual block
    log_std_min: float = -10.0
    log_std_max: float = 2.0

    def _net(self, out: int) -> NormalisedNet:
        return NormalisedNet(self.hidden[0], len(self.hidden), out)

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial parameters. The key is consumed."""
        return normalised.init(self._net(2 * spec.act), key, spec.n)

    def observe(self, params: dict[str, Any], x: Array) -> dict[str, Any]:
        """`params`: the statistics are those of `in_batch`."""
        return params

    def gaussian(self, params: dict[str, Any], x: Array) -> tuple[Array, Array]:
        """The mean mu and standard deviation sigma [..., m] before tanh, at x [..., n]."""
        return self._split(normalised.apply(self._net(normalised.outputs(params)), params, x))

    def _split(self, both: Array) -> tuple[Array, Array]:
        mu, s = jnp.split(both, 2, axis=-1)
        low, high = self.log_std_min, self.log_std_max
        return mu, jnp.exp(low + (high - low) * (1 + jnp.tanh(s)) / 2)

    def in_batch(
        self, params: dict[str, Any], x: Array, noise: Array
    ) -> tuple[Array, Array, dict[str, Any]]:
        """`sample` at x [B, n], normalised by that batch; parameters with its statistics."""
        net = self._net(normalised.outputs(params))
        both, params = normalised.apply_in_batch(net, params, x)
        return *sampled(*self._split(both), noise), params
