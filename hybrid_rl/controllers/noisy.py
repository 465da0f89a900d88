"""u = clip(u' + share e): exploration noise around any controller, whose action is u'.

    normal   e ~ level N(0, I)
    uniform  e ~ level U(-1, 1)
    ou       e' = (1 - theta dt) e + level sqrt(dt) N(0, I)       Ornstein-Uhlenbeck
    held     e ~ level N(0, I), drawn every `hold` decisions

share = decay^k max(1 - k / until, 0) after k decisions of the run; if it falls, 0 after training.
The baselines of ergodic exploration (thesis section 6.3.2), the exploration of deep deterministic
policy gradients (Lillicrap et al. 2016), and the executed noise of thesis Algorithm 2.
"""

from typing import Any, Literal, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import decay
from hybrid_rl.fields import Count, NotNegative, Share, part
from hybrid_rl.protocols import Controller
from hybrid_rl.types import Params, Spec


class NoisyState(NamedTuple):
    """The noise, and the inner controller's state."""

    e: Array  # [m]
    count: Array  # [] decisions of the episode so far
    dt: Array  # [s] of a decision
    inner: Any


@part
class NoisyController:
    """`controller` with noise during training, without noise in evaluation."""

    controller: Controller
    kind: Literal["normal", "uniform", "ou", "held"] = "normal"
    level: NotNegative = 0.1  # [u], of ou [u / sqrt(s)]
    theta: NotNegative = 0.15  # [1/s] of ou
    hold: Count = 1  # [decisions] of held
    decay: Share = 1.0  # factor per decision of the run
    until: Count | None = None  # decisions of the run until the noise is 0; None: never

    def init(self, spec: Spec) -> NoisyState:
        """No noise yet."""
        none, dt = jnp.zeros((), jnp.int32), jnp.float32(spec.dt)
        return NoisyState(jnp.zeros(spec.act), none, dt, self.controller.init(spec))

    def act(
        self, params: Params, state: NoisyState, obs: Array, key: Array
    ) -> tuple[Array, NoisyState, dict[str, Array]]:
        """Action [m], next state, metrics of the inner controller. The key is consumed."""
        acting, drawing = jax.random.split(key)
        u, inner, metrics = self.controller.act(params, state.inner, obs, acting)
        e = self._noise(state, drawing)
        after = NoisyState(e, state.count + 1, state.dt, inner)
        k, share = params.decisions, decay.of_run(self.decay, params.decisions)
        if self.until is not None:
            share = 0.0 if k is None else share * jnp.maximum(1 - k / self.until, 0)
        return jnp.clip(u + share * e, -1, 1), after, metrics

    def _noise(self, state: NoisyState, key: Array) -> Array:
        """The noise e [m] of this decision. The key is consumed."""
        if self.kind == "uniform":
            return self.level * jax.random.uniform(key, state.e.shape, minval=-1, maxval=1)
        e = self.level * jax.random.normal(key, state.e.shape)
        if self.kind == "ou":
            return (1 - self.theta * state.dt) * state.e + jnp.sqrt(state.dt) * e
        if self.kind == "held":
            return jnp.where(state.count % self.hold == 0, e, state.e)
        return e

    def greedy(self) -> Controller:
        """The inner controller without exploration."""
        return self.controller.greedy()
