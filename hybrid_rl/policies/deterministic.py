"""u = squash(mu(x)): a deterministic policy for imitation, with a known sigma.

    z ~ N(mu(x), sigma^2 I),   u = tanh(z), or clip(z, -1, 1)

Behaviour cloning then is least squares: with `clip` of mu(x) - u, with `tanh` of mu(x) - atanh(u).
`unsquashed` is mu(x), whose derivatives in the weights give the Fisher information of a
demonstration. Source: thesis section 4.2, with sigma "assumed known"; the squashing is ours.

With `saturation` s an action of s or more counts as one that was clipped: mu(x) may lie beyond it,
so the error counts on one side only (a censored regression, as in Tobin 1958, by squares).

`Clones` are several such networks with different initial weights, of which the first one acts, or
the mean of their mu (an ensemble: Dietterich 2000, without bootstrap samples).
"""

from typing import Any, Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.fields import Inside, Positive, Several, part
from hybrid_rl.networks import (
    MLP,
    Activation,
    Perceptron,
    Widths,
    apply,
    outputs,
    perceptron,
    side_by_side,
)
from hybrid_rl.types import Spec


@part
class Deterministic:
    """A network with a standard deviation that is not learned.

    Its parameters are the network's "weights" and, with `normalise`, statistics of "state".
    """

    hidden: Widths = (32, 32)
    activation: Activation = "relu"
    sigma: Positive = 1.0  # of z
    squash: Literal["tanh", "clip"] = "tanh"  # of z
    normalise: bool = False
    saturation: Inside | None = None  # [u] actions of this size or more count as clipped

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial parameters. The key is consumed."""
        net = MLP(self.hidden, spec.act, self.activation)
        state = {"state": statistics.init(spec.n)} if self.normalise else {}
        return {**state, "weights": net.init(key, jnp.zeros(spec.n))["params"]}

    def observe(self, params: dict[str, Any], x: Array) -> dict[str, Any]:
        """Parameters with statistics updated by states x [B, n]."""
        return statistics.observed(params, x)

    def unsquashed(self, params: dict[str, Any], x: Array) -> Array:
        """mu [..., m] at x [..., n]."""
        weights = {"params": params["weights"]}
        net = MLP(self.hidden, outputs(weights), self.activation)
        return apply(net, weights, statistics.inputs(params, x))

    def perceptron(self, params: dict[str, Any], spec: Spec) -> Perceptron:
        """The policy as plain arrays."""
        net, state = params["weights"], params.get("state")
        return perceptron(net, state, spec.n, spec.act, self.activation, self.squash)

    def mean(self, params: dict[str, Any], x: Array) -> Array:
        """The action [..., m] at x [..., n]."""
        return self._squashed(self.unsquashed(params, x))

    def _squashed(self, z: Array) -> Array:
        return jnp.tanh(z) if self.squash == "tanh" else jnp.clip(z, -1, 1)

    def variance(self, params: dict[str, Any], x: Array) -> Array:
        """Variance [..., m] of the action, to first order: sigma^2, times (1 - u^2)^2 with tanh."""
        u = self.mean(params, x)
        slope = 1 - u**2 if self.squash == "tanh" else jnp.ones_like(u)
        return (slope * self.sigma) ** 2

    def sample(self, params: dict[str, Any], x: Array, noise: Array) -> tuple[Array, Array]:
        """The action [..., m] for noise [..., m] ~ N(0, I), and the log-density [...] of z."""
        z = self.unsquashed(params, x) + self.sigma * noise
        return self._squashed(z), self._log_normal(noise)

    def log_prob(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """The log-density [...] of z at actions u [..., m], inside (-1, 1) with tanh."""
        s = self.saturation
        u = u if s is None else jnp.clip(u, -s, s)
        z = jnp.arctanh(u) if self.squash == "tanh" else u
        error = z - self.unsquashed(params, x)
        if s is not None:
            error = jnp.where(jnp.abs(u) < s, error, jnp.sign(u) * jax.nn.relu(jnp.sign(u) * error))
        return self._log_normal(error / self.sigma)

    def _log_normal(self, noise: Array) -> Array:
        constant = jnp.log(self.sigma) + 0.5 * jnp.log(2 * jnp.pi)
        return -jnp.sum(0.5 * noise**2 + constant, axis=-1)


@part
class Clones(Deterministic):
    """`members` networks that learn from the same data.

    Its "weights" have a first axis [members].
    """

    members: Several = 5
    acts: Literal["first", "mean"] = "first"  # mean: mu is the mean over the members

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial parameters, different for each member. The key is consumed."""
        keys = jax.random.split(key, self.members)
        each = jax.vmap(lambda key: super(Clones, self).init(key, spec)["weights"])(keys)
        return {**super().init(key, spec), "weights": each}

    def unsquashed(self, params: dict[str, Any], x: Array) -> Array:
        """mu [..., m] of the first member, or their mean."""
        if self.acts == "first":
            return super().unsquashed(self._member(params, 0), x)
        return self._each(params, x).mean(0)

    def perceptron(self, params: dict[str, Any], spec: Spec) -> Perceptron:
        """The policy as plain arrays; the mean of the members is one network of all their units."""
        if self.acts == "first":
            return super().perceptron(self._member(params, 0), spec)
        alone = super().perceptron
        return side_by_side([alone(self._member(params, i), spec) for i in range(self.members)])

    def _member(self, params: dict[str, Any], i: int) -> dict[str, Any]:
        return {**params, "weights": jax.tree.map(lambda each: each[i], params["weights"])}

    def _each(self, params: dict[str, Any], x: Array) -> Array:
        """mu [members, ..., m]."""
        one = super().unsquashed
        return jax.vmap(lambda weights: one({**params, "weights": weights}, x))(params["weights"])

    def each(self, params: dict[str, Any], x: Array) -> Array:
        """The action of every member [members, ..., m] at x [..., n]."""
        return self._squashed(self._each(params, x))

    def log_prob(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """The sum [...] over the members of the log-density of z."""
        one, each = super().log_prob, jax.tree.map(lambda w: w[:, None], params["weights"])
        return jax.vmap(lambda weights: one({**params, "weights": weights}, x, u))(each).sum(0)
