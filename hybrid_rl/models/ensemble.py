"""An ensemble of models, whose disagreement measures epistemic uncertainty.

    step = mean_i f_i(x, u),   draw = one member's prediction with its noise

Members differ by their initial weights and by their batches, which are drawn independently from one
replay memory. Deep ensembles (Lakshminarayanan et al. 2017), as in PETS and MBPO (Chua et al. 2018,
Janner et al. 2019), without a bootstrapped data set for each member.
"""

from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Count, part
from hybrid_rl.protocols import Trainable
from hybrid_rl.types import Spec


@part
class Ensemble:
    """`members` copies of `model`, each with its own "weights", with shared statistics."""

    model: Trainable
    members: Count = 5

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial parameters; weights have a first axis [members]. The key is consumed."""
        keys = jax.random.split(key, self.members)
        weights = jax.vmap(lambda k: self.model.init(k, spec)["weights"])(keys)
        return {**self.model.init(key, spec), "weights": weights}

    def observe(self, params: dict[str, Any], obs: Array, next_obs: Array) -> dict[str, Any]:
        """Parameters with statistics updated by observations [B, o] and their successors."""
        return self.model.observe(params, obs, next_obs)

    def lift(self, params: dict[str, Any], obs: Array) -> Array:
        """The planning state of an observation [o]."""
        return self.model.lift(params, obs)

    def each(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """The prediction of every member [members, n]."""

        def one(weights: Any) -> Array:
            return self.model.step({**params, "weights": weights}, x, u)

        return jax.vmap(one)(params["weights"])

    def step(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """Mean over the members [n]."""
        return self.each(params, x, u).mean(0)

    def predictions(self, params: dict[str, Any], x: Array, u: Array) -> tuple[Array, Array, Array]:
        """`step` [n], `disagreement` [n], with a finite gradient, and `each` [members, n]."""
        each = self.each(params, x, u)
        newest = each[:, : params["change"].mean.size]
        variance = newest.var(0) / params["change"].scale ** 2
        return each.mean(0), jnp.sqrt(variance + 1e-12), each

    def disagreement(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """Standard deviation [n] of the members' predictions, in running std of the change.

        It needs members with a `change`, as Gaussian has.
        """
        member: Any = self.model

        def one(weights: Any) -> Array:
            return member.change({**params, "weights": weights}, x, u)

        return jax.vmap(one)(params["weights"]).std(0)

    def draw(self, params: dict[str, Any], x: Array, u: Array, noise: Array, key: Array) -> Array:
        """Next states [B, n] for noise [B, n] ~ N(0, I), each of one member.

        The states are divided equally among the members; `key` decides which share each one gets.
        """
        count = self.members
        member_of = jax.random.permutation(key, count)  # of each share
        share_of = jnp.argmax(member_of[:, None] == jnp.arange(count)[None], 0)  # of each member
        missing = -len(x) % count

        def one(weights: Any, rows: Array) -> Array:
            x, u, noise = jnp.split(rows, (n, rows.shape[1] - n), axis=1)
            return self.model.draw({**params, "weights": weights}, x, u, noise, key)

        n, rows = x.shape[1], jnp.concatenate([x, u, noise], axis=1)
        rows = jnp.pad(rows, ((0, missing), (0, 0))).reshape(count, -1, rows.shape[1])
        # States are permuted: they are fewer numbers than weights.
        drawn = jax.vmap(one)(params["weights"], _permuted(rows, share_of, member_of))
        return _permuted(drawn, member_of, share_of).reshape(-1, n)[: len(x)]

    def loss(
        self, params: dict[str, Any], obs: Array, action: Array, next_obs: Array, key: Array
    ) -> Array:
        """Mean [] over the members of their losses, each on its own share of [members * B, ...]."""
        shares = [x.reshape(self.members, -1, x.shape[1]) for x in (obs, action, next_obs)]
        one = jax.vmap(lambda w, *share: self.model.loss({**params, "weights": w}, *share))
        return one(params["weights"], *shares, jax.random.split(key, self.members)).mean()


@jax.custom_vjp
def _permuted(x: Array, order: Array, inverse: Array) -> Array:
    """x[order]; its gradient takes the inverse order, where JAX's would add rows one by one."""
    return x[order]


_permuted.defvjp(
    lambda x, order, inverse: (x[order], inverse), lambda inverse, g: (g[inverse], None, None)
)
