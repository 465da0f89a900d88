"""Proximal policy optimisation (Schulman et al. 2017), for many worlds side by side.

    delta_t = r_t + gamma (1 - terminated) V(x_{t+1}) - V(x_t)
    A_t     = delta_t + gamma lambda (1 - done) A_{t+1}             (Schulman et al. 2016, GAE)
    L_pi    = -mean min(rho A, clip(rho, 1 - e, 1 + e) A) - c H,    rho = pi(u|x) / pi_old(u|x)
    L_V     = mean (V(x) - (A + V_old(x)))^2 / 2

Every `unroll` decisions of each world the policy learns from these alone: `epochs` passes in
`minibatches` parts. Until then it does not change, so pi_old follows from its parameters. A time
limit is bootstrapped through. Rewards are divided by `params.scale` where it is learned
(learners.return_scale). With `target_kl` the learning rate follows the change of the policy, as in
RSL-RL (Rudin et al. 2022). Defaults lie among those of Brax' and Playground's locomotion tasks.
"""

from functools import partial
from typing import Any, ClassVar, NamedTuple

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.core import returns, statistics
from hybrid_rl.fields import Count, Discount, Fraction, Inside, NotNegative, Positive, part
from hybrid_rl.networks import MLP, Activation, Widths, apply
from hybrid_rl.protocols import LearnedPolicy
from hybrid_rl.types import Batch, Params, Spec

SLOWEST, FASTEST = 1e-5, 1e-2  # learning rates with `target_kl`
METRICS = tuple(f"ppo/{of}" for of in ("policy_loss", "value_loss", "entropy", "kl", "rate"))


@struct.dataclass
class PPOState:
    """Policy and value function, their optimiser, and the decisions since the last update."""

    policy: Any
    value: Any
    seen: statistics.Running  # of the states, for the value function
    optimiser: Any
    rate: Array  # []
    decisions: Batch  # [T, E, ...]
    found: dict[str, Array]  # metrics of the last update; 0 before the first


class Rows(NamedTuple):
    """Decisions [B] as the policy learns from them."""

    x: Array  # [B, n]
    u: Array  # [B, m]
    log_prob: Array  # [B] under the policy that made them
    gain: Array  # [B] advantage
    goal: Array  # [B] of the value


@part
class PPO:
    """A learner of a policy and of its value, from all decisions since its last update."""

    policy: LearnedPolicy
    num_envs: Count = 1
    unroll: Count = 20  # decisions of each world between two updates
    epochs: Count = 4
    minibatches: Count = 32  # of equal size; what is left over waits for another pass
    discount: Discount = 0.99
    trace: Fraction = 0.95  # lambda
    clip: Inside = 0.3
    entropy: NotNegative = 0.01  # weight of the entropy
    learning_rate: Positive = 3e-4
    target_kl: Positive | None = None  # [nat] of an update; None: the rate stays
    max_grad_norm: Positive = 1.0
    hidden: Widths = (256, 256, 256)  # of the value function
    activation: Activation = "silu"

    data: ClassVar[str] = "latest"
    owns: ClassVar[tuple[str, ...]] = ("policy",)
    every: ClassVar[int] = 1

    @property
    def _net(self) -> MLP:
        return MLP(self.hidden, 1, self.activation)

    @property
    def _optimiser(self) -> optax.GradientTransformation:
        return optax.chain(optax.clip_by_global_norm(self.max_grad_norm), optax.scale_by_adam())

    def init(self, key: Array, spec: Spec) -> PPOState:
        """Initial parameters and no decisions. The key is consumed."""
        for_policy, for_value = jax.random.split(key)
        policy = self.policy.init(for_policy, spec)
        value = self._net.init(for_value, jnp.zeros(spec.n))
        empty = jnp.zeros((self.unroll, self.num_envs))
        obs, action = (jnp.zeros((*empty.shape, size)) for size in (spec.n, spec.act))
        decisions = Batch(obs, action, empty, empty, empty, obs)
        optimiser = self._optimiser.init((policy, value))
        rate = jnp.float32(self.learning_rate)
        seen, found = statistics.init(spec.n), dict.fromkeys(METRICS, jnp.zeros(()))
        return PPOState(policy, value, seen, optimiser, rate, decisions, found)

    def params(self, state: PPOState) -> dict[str, Any]:
        """The policy."""
        return {"policy": state.policy}

    def update(
        self, state: PPOState, params: Params, batch: Batch, key: Array
    ) -> tuple[PPOState, dict[str, Array]]:
        """`state` with the decisions [E] of a round, after an update if they are enough.

        Metrics are those of the last update. The key is consumed.
        """
        assert params.decisions is not None
        slot = (params.decisions // self.num_envs) % self.unroll
        kept = jax.tree.map(lambda all_, new: all_.at[slot].set(new), state.decisions, batch)
        state = state.replace(decisions=kept)
        learned = partial(self._learned, scale=params.scale, key=key)
        state = jax.lax.cond(slot == self.unroll - 1, learned, lambda state: state, state)
        return state, state.found

    def _value(self, state: PPOState, value: Any, x: Array) -> Array:
        """V [...] at x [..., n]."""
        return apply(self._net, value, statistics.normalise(state.seen, x))[..., 0]

    def advantages(self, state: PPOState, scale: Array | float) -> tuple[Array, Array]:
        """Advantages A and values V [T, E] of the decisions, for rewards over `scale`."""
        made = state.decisions
        values, after = (self._value(state, state.value, x) for x in (made.obs, made.next_obs))
        going = 1 - made.terminated
        delta = made.reward / scale + self.discount * going * after - values
        follows = self.discount * self.trace * going * (1 - made.truncated)
        sums = jax.vmap(returns.to_go, (1, 1, 0), 1)(delta, follows, jnp.zeros(self.num_envs))
        return sums[:-1], values

    def _learned(self, state: PPOState, scale: Any, key: Array) -> PPOState:
        """`state` after the passes over its decisions."""
        made = state.decisions
        old = self.policy.log_prob(state.policy, made.obs, made.action)
        x = made.obs.reshape(-1, made.obs.shape[-1])
        seen = statistics.update(state.seen, x)
        state = state.replace(seen=seen, policy=self.policy.observe(state.policy, x))
        advantage, values = self.advantages(state, 1.0 if scale is None else scale)
        whole = Rows(made.obs, made.action, old, advantage, advantage + values)
        flat: Rows = jax.tree.map(lambda leaf: leaf.reshape(-1, *leaf.shape[2:]), whole)

        def one(state: PPOState, given: tuple[Array, Array]) -> tuple[PPOState, dict[str, Array]]:
            at, key = given
            return self._step(state, jax.tree.map(lambda leaf: leaf[at], flat), key)

        def epoch(state: PPOState, key: Array) -> tuple[PPOState, dict[str, Array]]:
            mixing, drawing = jax.random.split(key)
            parts = min(self.minibatches, len(x))
            order = jax.random.permutation(mixing, len(x))[: len(x) // parts * parts]
            given = order.reshape(parts, -1), jax.random.split(drawing, parts)
            return jax.lax.scan(one, state, given)

        state, found = jax.lax.scan(epoch, state, jax.random.split(key, self.epochs))
        return state.replace(found=jax.tree.map(jnp.mean, found))

    def _step(self, state: PPOState, rows: Rows, key: Array) -> tuple[PPOState, dict[str, Array]]:
        """`state` after a step on decisions [B], and its metrics. The key is consumed."""
        gain = (rows.gain - rows.gain.mean()) / (rows.gain.std() + 1e-8)
        noise = jax.random.normal(key, rows.u.shape)

        def loss(both: tuple[Any, Any]) -> tuple[Array, tuple[Array, ...]]:
            policy, value = both
            log_ratio = self.policy.log_prob(policy, rows.x, rows.u) - rows.log_prob
            ratio = jnp.exp(log_ratio)
            near = jnp.clip(ratio, 1 - self.clip, 1 + self.clip)
            of_policy = -jnp.minimum(ratio * gain, near * gain).mean()
            entropy = -self.policy.sample(policy, rows.x, noise)[1].mean()
            of_value = 0.5 * ((self._value(state, value, rows.x) - rows.goal) ** 2).mean()
            kl = (ratio - 1 - log_ratio).mean()
            found = (of_policy, of_value, entropy, kl)
            return of_policy + 0.5 * of_value - self.entropy * entropy, found

        both = state.policy, state.value
        (_, found), grads = jax.value_and_grad(loss, has_aux=True)(both)
        change, optimiser = self._optimiser.update(grads, state.optimiser)
        down = jax.tree.map(lambda g: -state.rate * g, change)
        policy, value = (optax.apply_updates(*pair) for pair in zip(both, down, strict=True))
        rate = state.rate
        if self.target_kl is not None:
            far, close = found[-1] > 2 * self.target_kl, found[-1] < self.target_kl / 2
            rate = jnp.clip(
                rate * jnp.where(far, 1 / 1.5, jnp.where(close, 1.5, 1.0)), SLOWEST, FASTEST
            )
        made = state.replace(policy=policy, value=value, optimiser=optimiser, rate=rate)
        return made, dict(zip(METRICS, (*found, rate), strict=True))
