"""u = tanh(z), z ~ N(mu(x), diag(sigma(x)^2)): the squashed Gaussian policy.

log pi(u|x) = log N(z; mu, sigma) - sum_i log(1 - tanh(z_i)^2)      (Haarnoja et al. 2018, eq. 21)

One trunk with two heads, or two networks (thesis appendix B: a sine layer for the mean, a
rectified layer for the standard deviation) if `log_std_activation` is set. With `normalise` their
inputs are states divided by their running standard deviation in the learner's data: the
demonstrations for behaviour cloning, the batches for SAC and DDPG.
"""

from collections.abc import Mapping
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.core.squashing import Squashed
from hybrid_rl.data import archive
from hybrid_rl.fields import Positive, part
from hybrid_rl.networks import MLP, Activation, Perceptron, Widths, apply, outputs, perceptron
from hybrid_rl.protocols import Env
from hybrid_rl.types import Spec


@part
class TanhGaussian(Squashed):
    """A stochastic policy on [-1, 1]^m."""

    hidden: Widths = (256, 256)
    activation: Activation = "relu"
    log_std_activation: Activation | None = None  # None: one trunk for mean and log_std
    log_std_min: float = -5.0
    log_std_max: float = 2.0
    std: Positive = 1.0  # a factor of sigma: about its first value
    normalise: bool = False

    def _net(self, out: int, activation: str | None = None) -> MLP:
        return MLP(self.hidden, out, activation or self.activation)

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial parameters. The key is consumed."""
        x, m = jnp.zeros(spec.n), spec.act
        state = {"state": statistics.init(spec.n)} if self.normalise else {}
        if self.log_std_activation is None:
            return {**state, "trunk": self._net(2 * m).init(key, x)}
        mean, log_std = jax.random.split(key)
        return {
            **state,
            "mean": self._net(m).init(mean, x),
            "log_std": self._net(m, self.log_std_activation).init(log_std, x),
        }

    def observe(self, params: dict[str, Any], x: Array) -> dict[str, Any]:
        """Parameters with statistics updated by states x [B, n]."""
        return statistics.observed(params, x)

    def gaussian(self, params: dict[str, Any], x: Array) -> tuple[Array, Array]:
        """The mean mu and standard deviation sigma [..., m] before tanh, at x [..., n]."""
        x = statistics.inputs(params, x)
        if self.log_std_activation is None:
            both = apply(self._net(outputs(params["trunk"])), params["trunk"], x)
            mu, log_std = jnp.split(both, 2, axis=-1)
        else:
            m = outputs(params["mean"])
            mu = apply(self._net(m), params["mean"], x)
            log_std = apply(self._net(m, self.log_std_activation), params["log_std"], x)
        log_std = log_std + jnp.log(self.std)
        return mu, jnp.exp(jnp.clip(log_std, self.log_std_min, self.log_std_max))

    def perceptron(self, params: dict[str, Any], spec: Spec) -> Perceptron:
        """The mean as plain arrays."""
        net = params["trunk" if self.log_std_activation is None else "mean"]["params"]
        state = params.get("state")
        return perceptron(net, state, spec.n, spec.act, self.activation, "tanh")


@part
class StartedGaussian(TanhGaussian):
    """A policy that learns and begins with the parameters in `file`, of `task` in `world`."""

    file: str = ""
    task: str = ""
    world: Env | None = None
    episode: Mapping[str, int] | None = None  # with `action_repeat`; None: 1

    def __post_init__(self) -> None:
        assert self.world is not None  # a default, as fields before it have one
        self.init(jax.random.key(0), self.world.spec)

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """The parameters of the file."""
        world: Any = self.world
        like = jax.eval_shape(lambda: super(StartedGaussian, self).init(key, spec))
        return archive.policy(self.file, like, self.task, world, self.episode)
