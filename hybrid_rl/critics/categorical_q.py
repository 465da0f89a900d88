"""Q(x, u) as the mean of a distribution over returns, from networks with unit weights.

    Q_i(x, u) = sum_k p_i,k(x, u) z_k,    z_1 = -bound, ..., z_bins = bound, evenly spaced

The target moves the atoms of the member with the smaller Q and shares each one's probability
between its two neighbours (Bellemare et al. 2017, C51):

    y_k = clip(r + c (z_k - penalty), -bound, bound)
    q_j = sum_k p_k max(0, 1 - |y_k - z_j| / (z_2 - z_1))

Returns must be scaled to the bounds (hybrid_rl.learners.return_scale). Source: the critic of
FlashSAC (Kim et al. 2026), with its width, blocks, atoms and bound.
"""

from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Count, Positive, Several, part
from hybrid_rl.networks import normalised
from hybrid_rl.networks.normalised import Blocks, NormalisedNet
from hybrid_rl.types import Spec


@part
class CategoricalQ:
    """`members` independent distributions over returns."""

    hidden: Blocks = (256, 256)  # the width, once for each residual block
    members: Count = 2
    bins: Several = 101  # atoms
    bound: Positive = 5.0  # of scaled returns

    @property
    def atoms(self) -> Array:
        """z [bins]."""
        return jnp.linspace(-self.bound, self.bound, self.bins)

    def _net(self) -> NormalisedNet:
        return NormalisedNet(self.hidden[0], len(self.hidden), self.bins)

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial parameters, members on axis 0. The key is consumed."""
        keys, net = jax.random.split(key, self.members), self._net()
        return jax.vmap(lambda k: normalised.init(net, k, spec.n + spec.act))(keys)

    def observe(self, params: dict[str, Any], x: Array, returns: Array) -> dict[str, Any]:
        """`params`: the statistics are those of `in_batch`."""
        return params

    def all(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """Q of every member [members, ...] at x [..., n] and u [..., m]."""
        logits = jax.vmap(lambda p, xu: normalised.apply(self._net(), p, xu))(
            params, self._inputs(x, u)
        )
        return jax.nn.softmax(logits) @ self.atoms

    def value(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """The minimum of Q [...] over the members."""
        return self.all(params, x, u).min(0)

    def in_batch(self, params: dict[str, Any], x: Array, u: Array) -> tuple[Array, dict[str, Any]]:
        """log p [members, B, bins] at x [B, n] and u [B, m], normalised by that batch.

        Also the parameters with the batch's statistics.
        """
        logits, params = jax.vmap(lambda p, xu: normalised.apply_in_batch(self._net(), p, xu))(
            params, self._inputs(x, u)
        )
        return jax.nn.log_softmax(logits), params

    def target(self, log_p: Array, reward: Array, factor: Array, penalty: Array) -> Array:
        """q [B, bins] after log p [members, B, bins]; reward r, factor c and penalty [B]."""
        p, z = jnp.exp(log_p), self.atoms
        least = jnp.argmin(p @ z, axis=0)  # [B]
        p = jnp.take_along_axis(p, least[None, :, None], axis=0)[0]
        y = reward[:, None] + factor[:, None] * (z[None] - penalty[:, None])  # [B, bins]
        y = jnp.clip(y, -self.bound, self.bound)
        distance = jnp.abs(y[:, :, None] - z[None, None]) / (z[1] - z[0])
        return (p[:, :, None] * jnp.maximum(0.0, 1.0 - distance)).sum(1)

    def _inputs(self, x: Array, u: Array) -> Array:
        """The inputs [members, ..., n + m], repeated as in hybrid_rl.networks.ensemble_apply."""
        xu = jnp.concatenate([x, u], -1)
        return jnp.broadcast_to(xu, (self.members, *xu.shape))
