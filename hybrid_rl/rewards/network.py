"""A network for r(x, u) and the end of episodes (thesis appendix B: two layers of 200).

    r = m + s f(x, u)

with m = 0 and s = 1, or with `scale` the running mean and standard deviation of the rewards, so
that their error counts in units of s, as a model's errors count in running standard deviations
(Barkley and Fridovich-Keil 2025). With several `members`, f is the mean of networks that differ by
their initial weights.

With `next_state` it is f(x, u, x'), of the true next state in the data and of the imagined one in a
model: a reward for distance depends on both states, and from x and u alone the network would have
to learn the dynamics again.

Ends are learned as a second output, or known by the rule of a task, from its next observation.
"""

from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.fields import Count, part
from hybrid_rl.networks import MLP, Activation, Widths, ensemble_apply, ensemble_init
from hybrid_rl.types import Params, Spec

CERTAIN = 20.0  # logit of a known end: a probability of 1 - 2e-9


@part
class RewardNetwork:
    """A reward, and with `ends` the probability that the episode ends."""

    hidden: Widths = (200, 200)
    activation: Activation = "relu"
    normalise: bool = True  # states by their running statistics
    ends: bool = False  # also where episodes end
    rule: object = None  # an environment whose `ended` gives the ends; without: they are learned
    layer_norm: bool = False  # of every hidden layer
    scale: bool = False  # targets by their running statistics
    members: Count = 1  # networks, whose mean is used
    next_state: bool = False  # x' is an input, too

    @property
    def _known(self) -> bool:
        """Whether ends are known."""
        return self.ends and getattr(self.rule, "ended", None) is not None

    def _net(self) -> MLP:
        out = 1 + (self.ends and not self._known)
        return MLP(self.hidden, out, self.activation, self.layer_norm)

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial weights and statistics. The key is consumed."""
        size = spec.n + spec.act + (spec.n if self.next_state else 0)
        net, zeros = self._net(), jnp.zeros(size)
        several = self.members > 1
        weights = ensemble_init(net, key, self.members, zeros) if several else net.init(key, zeros)
        params = {"weights": weights, "state": statistics.init(spec.n)}
        return {**params, "target": statistics.init(1)} if self.scale else params

    def observe(self, params: dict[str, Any], x: Array) -> dict[str, Any]:
        """Parameters with statistics updated by x [B, n]."""
        return statistics.observed(params, x) if self.normalise else params

    def observe_targets(self, params: dict[str, Any], target: Array) -> dict[str, Any]:
        """Parameters with statistics updated by targets [B] of the reward."""
        return statistics.observed(params, target[:, None], "target")

    def outcome(self, params: Params, x: Array, u: Array, after: Array) -> tuple[Array, Array]:
        """The reward [] of u [m] at x [n], and the logit [] of the episode ending there.

        after: [n] the next state, which is used with `next_state` and with a rule.
        """
        rewards, logits = self._each(params.reward, x, u, after)
        if self._known:
            ended = self.rule.ended(after[: self.rule.spec.obs])
            return rewards.mean(), jnp.where(ended, CERTAIN, -CERTAIN)
        return rewards.mean(), logits.mean() if self.ends else -jnp.inf

    def _each(
        self, params: dict[str, Any], x: Array, u: Array, after: Array
    ) -> tuple[Array, Array]:
        """Reward and logit [members] of every network; without ends the logits are zero."""
        inputs = [statistics.normalise(params["state"], x), u]
        if self.next_state:
            inputs.append(statistics.normalise(params["state"], after))
        inputs = jnp.concatenate(inputs)
        net, weights = self._net(), params["weights"]
        several = self.members > 1
        out: Any = (ensemble_apply if several else MLP.apply)(net, weights, inputs)
        out = out.reshape(self.members, -1)
        r = out[:, 0]
        if self.scale:
            r = params["target"].mean + params["target"].scale * r
        return r, out[:, 1:].sum(1)

    def loss(
        self, params: dict[str, Any], x: Array, u: Array, after: Array, target: Array, ended: Array
    ) -> Array:
        """Half the squared error [] against target [], and the cross entropy of `ended` [].

        With `scale`, the error is in running standard deviations of the targets. Mean over members.
        """
        rewards, logits = self._each(params, x, u, after)
        error = target - rewards
        if self.scale:
            error = error / params["target"].scale
        losses = 0.5 * error**2
        if self.ends and not self._known:
            losses = losses + jax.nn.softplus(logits) - ended * logits
        return losses.mean()
