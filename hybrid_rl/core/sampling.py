"""Sampling core: path-integral planning over K imagined paths.

    x_0^k = x,   v_t^k ~ propose(x_t^k, a_t),   x_{t+1}^k = f(x_t^k, v_t^k)
    S_t^k = return from t on along path k
    w_t^k = softmax_k( S_t^k / lambda  [+ log p(v_t^k)] ),   a_t <- sum_k w_t^k v_t^k

Thesis Algorithm 3 and eq. (3.8), whose term log p(v) is optional. Without it, for v drawn from q,
sum_k w_k v_k estimates the mean of the distribution proportional to q(v) exp(S / lambda). This is
the mean of Theorem 2 if q is its p. For another q the weights would need the importance ratio
p / q, which is left out: candidates of a mixture are weighted as if the mixture were p. Noise
around the plan is Williams et al. 2017, eq. 20-27, with alpha = 1: q is the prior, so the weight
has no control cost lambda a' Sigma^-1 e.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core import returns, rollout
from hybrid_rl.core.batching import repeat
from hybrid_rl.core.lifting import policy_input
from hybrid_rl.protocols import Proposal
from hybrid_rl.types import Params, Path, PyTree, Reward, Spec, Step


class Samples(NamedTuple):
    """K imagined paths."""

    path: Path  # x [K, T+1, n]; u [K, T, m]
    log_prob: Array  # [K, T] of u under the proposal


class Kept(NamedTuple):
    """The state of a planner between two decisions."""

    plan: Array  # [T, m] from the next decision on
    u: Array  # [m] the previous action
    memory: Any  # of the objective
    more: PyTree = None  # a planner's own

    def later(self, plan: Array, u: Array, memory: Any, rest: float = 0.0) -> "Kept":
        """The state after `plan` [T, m], of which u [m] acts: shifted, where the two are finite."""
        after = shift(sound(plan, rest), rest)
        return self._replace(plan=after, u=sound(u, rest), memory=memory)


def imagine(
    step: Callable[[Any, Array], Any],
    propose: Callable[[Any, Any, Array, Any], tuple[Array, Array, Any]],
    carries: Any,
    x: Any,
    plan: Array,
    noise: Any,
) -> Samples:
    """K paths of the model `step` from x [K, n], with candidates around plan [T, m].

    `propose(carries, x [K, n], a_t [m], noise [K, ...]) -> (v [K, m], log_prob [K], carries)` makes
    the candidates of a decision from the noise [K, T, ...] ~ N(0, I), or what a proposal has made
    of it; `carries` start the paths. x may be any tree of arrays.
    """

    def act(carries: Any, x: Any, at: tuple[Array, Any]) -> tuple[Array, Any, Array]:
        v, log_prob, carries = propose(carries, x, *at)
        return v, carries, log_prob

    def move(x: Any, v: Array) -> tuple[Any, None]:
        return jax.vmap(step)(x, v), None

    path, _, log_prob = rollout.roll(move, act, x, (plan, _swapped(noise)), carries)
    return Samples(_swapped(path), log_prob.T)


def _swapped(tree: Any) -> Any:
    """A tree [K, T, ...] as [T, K, ...], or the reverse."""
    return jax.tree.map(lambda leaf: leaf.swapaxes(0, 1), tree)


class Candidates:
    """`count` candidates of a proposal; those of a mixture's parts follow each other.

    Each part is evaluated for its own candidates alone.
    """

    def __init__(self, proposal: Proposal, count: int) -> None:
        quantiles = np.arange(count, dtype=np.float32) / np.float32(count)
        self.parts, self.count = parts_of(proposal, quantiles), count
        self.ends = np.cumsum([len(quantiles) for _, quantiles in self.parts])[:-1]

    def begin(self, spec: Spec) -> Any:
        """The carries before the first decision, of each part."""
        return [jax.vmap(partial(part.init, spec))(jnp.asarray(q)) for part, q in self.parts]

    def imagine(
        self, params: Params, step: Step, carries: Any, x: Any, plan: Array, key: Array
    ) -> Samples:
        """Their paths in the model `step` from x [n], around plan [T, m]. The key is consumed."""
        noise = jnp.split(jax.random.normal(key, (self.count, *plan.shape)), self.ends)
        shaped = [jax.vmap(part.shaped)(e) for (part, _), e in zip(self.parts, noise, strict=True)]

        def propose(carries: Any, x: Any, a: Array, noise: Any) -> tuple[Array, Array, Any]:
            each = zip(carries, jnp.split(policy_input(x), self.ends), noise, strict=True)
            drawn = [
                jax.vmap(part, (None, 0, 0, None, 0))(params, carry, x, a, e)
                for (part, _), (carry, x, e) in zip(self.parts, each, strict=True)
            ]
            v, log_prob, carries = zip(*drawn, strict=True)
            return jnp.concatenate(v), jnp.concatenate(log_prob), list(carries)

        return imagine(step, propose, carries, repeat(x, self.count), plan, shaped)


def parts_of(proposal: Proposal, quantiles: np.ndarray) -> list[tuple[Proposal, np.ndarray]]:
    """The parts of a mixture, nested or not, with the quantiles of their candidates."""
    if not len(quantiles):
        return []
    split = getattr(proposal, "split", None)
    if split is None:
        return [(proposal, quantiles)]
    return [each for part, own in split(quantiles) for each in parts_of(part, own)]


def weights(
    reward_to_go: Array, temperature: float, normalise: bool = False, log_prob: Array | None = None
) -> Array:
    """Weights [K, T] that sum to one over K, from reward_to_go S [K, T].

    `normalise` divides S by its standard deviation over K, so that `temperature` is a pure
    number; otherwise it has the unit of a return. `log_prob` [K, T] is added to the exponent.
    A return that is NaN or infinite has no weight; where none is finite, the weights are NaN.

    Only differences of returns matter, so the best return is first subtracted. A compiled softmax
    would otherwise round a large S / lambda differently where it uses it twice, and overflow.
    """
    finite = jnp.isfinite(reward_to_go)
    worst = jnp.min(reward_to_go, axis=0, initial=jnp.inf, where=finite, keepdims=True)
    reward_to_go = jnp.where(finite, reward_to_go, worst)
    reward_to_go = reward_to_go - reward_to_go.max(axis=0, keepdims=True)
    if normalise:
        std = jnp.std(reward_to_go, axis=0, keepdims=True)
        reward_to_go = reward_to_go / (std + 1e-6)
    exponent = reward_to_go / temperature
    if log_prob is not None:
        exponent = exponent + log_prob
    return jax.nn.softmax(jnp.where(finite, exponent, -jnp.inf), axis=0)


def kept(w: Array, x: Array) -> Array:
    """x, or 0 where its weight is 0: a path without weight may be NaN. w and x broadcast."""
    return jnp.where(w > 0, x, 0.0)


def sound(u: Array, rest: float) -> Array:
    """Actions u, with `rest` for those that are not finite: from these the next plan can begin."""
    return jnp.where(jnp.isfinite(u), u, rest)


def effective_samples(w: Array) -> Array:
    """1 / sum_k w_k^2 [T] for w [K, T]: K if all weights are equal, 1 if only one is not 0."""
    return 1.0 / jnp.sum(w**2, axis=0)


def shift(plan: Array, rest: float = 0.0) -> Array:
    """The plan [T, m] one decision later: without its first action, with `rest` at the end."""
    return jnp.concatenate([plan[1:], jnp.full_like(plan[:1], rest)])


def plan(
    step: Step,
    reward: Reward,
    x: Array,
    before: Array,
    key: Array,
    *,
    samples: int = 100,
    std: float = 0.5,
    temperature: float = 0.1,
) -> Array:
    """The plan [T, m] from x [n]: the weighted mean of candidates around `before` [T, m] (MPPI).

    Candidates are clip(before + std N(0, I)) to [-1, 1]. Their returns are normalised over the
    candidates, so that `temperature` is a pure number. One whose return is NaN or infinite has no
    weight, so a reward of -inf forbids what it is paid for; where no return is finite, the plan is
    NaN. The key is consumed. Execute the first action and `shift` the rest:

        a = jnp.zeros((20, 1))  # 20 decisions
        for key in jax.random.split(jax.random.key(0), 60):
            a = plan(step, reward, x, a, key)
            x, a = step(x, a[0]), shift(a)
    """

    def propose(carry: None, x: Array, a: Array, noise: Array) -> tuple[Array, Array, None]:
        return jnp.clip(a[None] + std * noise, -1, 1), jnp.zeros(samples), carry

    def to_go(path: Path) -> Array:
        rewards = returns.rewards(reward, path)
        return returns.to_go(rewards, jnp.ones_like(rewards), jnp.zeros_like(rewards[0]))

    noise = jax.random.normal(key, (samples, *before.shape))
    path = imagine(step, propose, None, repeat(x, samples), before, noise).path
    S = jax.vmap(to_go)(path)[:, :-1]
    return jnp.einsum("kt,ktm->tm", weights(S, temperature, normalise=True), path.u)
