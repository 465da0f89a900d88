"""A learned one-step model, x' ~ N(x + f(x, u), diag(s^2)) (thesis appendix B).

f = W_2 a(W_1 [x, u] + b_1) + b_2 by default; s is constant, or with `state_noise` a network's
s(x) (thesis eq. 6.22). With `normalise`, the networks' inputs and outputs are divided by running
standard deviations. `inputs` selects the coordinates of the state that the networks see: a free
body's motion does not depend on its position, which flights near one position cannot teach.

With `input_noise` c it learns from x + c s N(0, I), though always to predict the same x'. So what
it predicts from its own errors returns to the states that exist, where an entry follows from others
(a sine and a cosine), instead of drifting away (Sanchez-Gonzalez et al. 2020, "Learning to simulate
complex physics with graph networks"). Noise that x does not reveal enlarges s: c is well below 1.

With `circles` what it predicts stays on the circles that pairs of entries lie on (`core.circles`).
"""

from typing import Annotated, Any, ClassVar

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import circles, history, statistics
from hybrid_rl.core.lifting import check_coordinates
from hybrid_rl.fields import FILLED, Fraction, part
from hybrid_rl.networks import MLP, Activation, Widths, apply
from hybrid_rl.types import Spec


@part
class Gaussian:
    """A one-step Gaussian model; the planning state is the observation."""

    hidden: Widths = (200,)
    activation: Activation = "relu"
    normalise: bool = True
    log_std_min: float = -10.0
    log_std_max: float = 2.0
    state_noise: bool = False  # s(x) instead of a constant
    inputs: Annotated[tuple[int, ...], FILLED] | None = None  # of x; None: all
    layer_norm: bool = False  # of every hidden layer
    input_noise: Fraction = 0.0  # of x in the loss, in s
    circles: bool = False  # predictions stay on the circles that were observed

    members: ClassVar[int] = 1  # an ensemble has more

    def _net(self, out: int) -> MLP:
        return MLP(self.hidden, out, self.activation, self.layer_norm)

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial weights and statistics. The key is consumed."""
        check_coordinates("model.inputs", self.inputs, spec.obs)
        new = spec.newest or spec.obs
        net, size, log_std = self._net(new), len(self._inputs(jnp.zeros(spec.obs))), jnp.zeros(new)
        if self.state_noise:
            log_std = net.init(jax.random.fold_in(key, 1), jnp.zeros(size))
        params = {
            "weights": {"net": net.init(key, jnp.zeros(size + spec.act)), "log_std": log_std},
            "state": statistics.init(spec.obs),
            "change": statistics.init(new),
        }
        if self.circles:
            params["circles"] = circles.init(new)
        return params if new == spec.obs else {**params, "period": jnp.float32(spec.dt)}

    def observe(self, params: dict[str, Any], obs: Array, next_obs: Array) -> dict[str, Any]:
        """Parameters with statistics updated by observations [B, o] and their successors."""
        new = params["change"].mean.size
        if self.circles:
            params = {**params, "circles": circles.update(params["circles"], next_obs[:, :new])}
        if not self.normalise:
            return params
        state = statistics.update(params["state"], obs)
        change = next_obs[:, :new] - obs[:, :new]
        change = statistics.update(params["change"], change, state.magnitude[:new])
        return {**params, "state": state, "change": change}

    def lift(self, params: dict[str, Any], obs: Array) -> Array:
        """The observation [o] itself."""
        return obs

    def change(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """Predicted change [n] of x [n] under u [m], in running standard deviations."""
        inputs = jnp.concatenate([self._inputs(statistics.normalise(params["state"], x)), u])
        new = params["change"].mean.size
        return apply(self._net(new), params["weights"]["net"], inputs)

    def std(self, params: dict[str, Any], x: Array) -> Array:
        """s [n] of the change at x [n], in running standard deviations."""
        log_std = params["weights"]["log_std"]
        if self.state_noise:
            inputs = self._inputs(statistics.normalise(params["state"], x))
            log_std = apply(self._net(params["change"].mean.size), log_std, inputs)
        return jnp.exp(jnp.clip(log_std, self.log_std_min, self.log_std_max))

    def step(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """Mean of the next planning state [n]."""
        return self._after(params, x, u, self.change(params, x, u))

    def draw(self, params: dict[str, Any], x: Array, u: Array, noise: Array, key: Array) -> Array:
        """Next planning states [B, n] for noise [B, n] ~ N(0, I); the key is not used."""

        def one(x: Array, u: Array, noise: Array) -> Array:
            change = self.change(params, x, u)
            change = change + self.std(params, x) * noise[: change.size]
            return self._after(params, x, u, change)

        return jax.vmap(one)(x, u, noise)

    def _after(self, params: dict[str, Any], x: Array, u: Array, change: Array) -> Array:
        """The state [n] after x [n] by a `change`; what is older in a history only shifts."""
        new = x[: change.size] + statistics.denormalise(params["change"], change)
        new = circles.onto(params["circles"], new) if self.circles else new
        return history.shifted(x, u, new, params["period"]) if "period" in params else new

    def _inputs(self, x: Array) -> Array:
        return x if self.inputs is None else x[jnp.array(self.inputs)]

    def loss(
        self, params: dict[str, Any], obs: Array, action: Array, next_obs: Array, key: Array
    ) -> Array:
        """Negative log-likelihood [] of next_obs [B, o], mean over its entries.

        The key of the input's noise is consumed.
        """
        noise = jax.random.normal(key, (len(obs), params["change"].mean.size))

        def one(x: Array, u: Array, next_x: Array, noise: Array) -> Array:
            std = self.std(params, x)
            if self.input_noise:
                noise = self.input_noise * params["change"].scale * std * noise
                x = x.at[: std.size].add(jax.lax.stop_gradient(noise))
            target = statistics.normalise(params["change"], next_x[: std.size] - x[: std.size])
            error = (target - self.change(params, x, u)) / std
            return jnp.mean(0.5 * error**2 + jnp.log(std) + 0.5 * jnp.log(2 * jnp.pi))

        return jax.vmap(one)(obs, action, next_obs, noise).mean()
