"""Branches: trajectories of a policy in a model that begin at real states (Janner et al. 2019).

`sample_fresh` draws them for each update. `Branches` are kept from one update to the next: each
update continues all of them by one decision and restarts those that ended or reached their length.
Then one decision of the model per update is enough for branches of any length, and thus for states
that the present policy leads to.
"""

from collections.abc import Callable

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.core.batching import where
from hybrid_rl.core.statistics import FLOOR
from hybrid_rl.protocols import Policy, Reward, Trainable
from hybrid_rl.types import Batch, Params

Transitions = Callable[[Array, Array, Array, Array], Batch]
"""x [b, n], noise [b, m] and [b, n], key -> a transition from each x."""


@struct.dataclass
class Branches:
    """B branches and the ring of their transitions."""

    x: Array  # [B, n] the states that the branches have reached
    age: Array  # [B] int32 decisions of each branch so far
    rows: Array  # [memory / B, B, width] the last transitions
    count: Array  # [] int32 updates so far

    def restarted(self) -> "Branches":
        """All start again at the next update, without the old transitions."""
        ended = jnp.full_like(self.age, jnp.iinfo(self.age.dtype).max)
        return self.replace(age=ended, count=jnp.zeros_like(self.count))


def transitions(params: Params, policy: Policy, model: Trainable, reward: Reward) -> Transitions:
    """u ~ pi(x), x' ~ f(x, u) and r, end = reward(x, u, x'); `terminated` is a probability."""

    def one(x: Array, for_policy: Array, for_model: Array, key: Array) -> Batch:
        u = jax.vmap(policy.sample, (None, 0, 0))(params.policy, x, for_policy)[0]
        after = model.draw(params.model, x, u, for_model, key)
        r, end = jax.vmap(reward.outcome, (None, 0, 0, 0))(params, x, u, after)
        return Batch(x, u, r, jax.nn.sigmoid(end), jnp.zeros(len(x)), after)

    return one


def begin(size: int, memory: int, n: int, m: int, steps: int) -> Branches:
    """`size` branches that are to start at the next update; memory: transitions, a multiple."""
    return Branches(
        jnp.zeros((size, n)),
        jnp.full(size, steps, jnp.int32),
        jnp.zeros((memory // size, size, 2 * n + m + 2)),
        jnp.zeros((), jnp.int32),
    )


def extended(
    branches: Branches,
    step: Transitions,
    start: Array,
    m: int,
    steps: int,
    key: Array,
    margin: float | None = None,
) -> Branches:
    """The branches one decision later; those to start begin at `start` [B, n].

    At the first update they start at different ages, so that later a part of them restarts at each
    update. With `margin` a branch ends, too, where an entry of its state is more than `margin`
    times the range of this entry in `start` below or above that range. The key is consumed.
    """
    acting, moving, choosing, aging = jax.random.split(key, 4)
    new = branches.age >= steps
    first = jax.random.randint(aging, new.shape, 0, steps)
    age = jnp.where(new, jnp.where(branches.count == 0, first, 0), branches.age)
    x = where(new, start, branches.x)
    for_policy = jax.random.normal(acting, (len(x), m))
    for_model = jax.random.normal(moving, x.shape)
    made = step(x, for_policy, for_model, choosing)
    flags = jnp.stack([made.reward, made.terminated], -1)
    rows = jnp.concatenate([made.obs, made.action, flags, made.next_obs], -1)
    slot = branches.count % len(branches.rows)
    ended = made.terminated > 0.5
    if margin is not None:
        ended |= _far(made.next_obs, start, margin)
    return Branches(
        made.next_obs,
        jnp.where(ended, steps, age + 1),
        jax.lax.dynamic_update_index_in_dim(branches.rows, rows, slot, 0),
        branches.count + 1,
    )


def _far(x: Array, real: Array, margin: float) -> Array:
    """Whether states x [B, n] leave the range of `real` [b, n], widened on both sides: [B].

    Entries that are constant in `real`, to float32's precision, do not count.
    """
    low, high = real.min(0, keepdims=True), real.max(0, keepdims=True)
    wide = high - low
    varies = wide > FLOOR * jnp.maximum(jnp.abs(low), jnp.abs(high))
    outside = (x < low - margin * wide) | (x > high + margin * wide)
    return (outside & varies).any(-1)


def sample_kept(branches: Branches, m: int, key: Array) -> Batch:
    """B transitions, uniform over those that are kept. The key is consumed."""
    length, size, width = branches.rows.shape
    known, n = jnp.minimum(branches.count, length) * size, branches.x.shape[1]
    rows = branches.rows.reshape(-1, width)[jax.random.randint(key, (size,), 0, known)]
    x, u, flags, after = jnp.split(rows, (n, n + m, n + m + 2), axis=1)
    return Batch(x, u, flags[:, 0], flags[:, 1], jnp.zeros(size), after)


def sample_fresh(step: Transitions, start: Array, m: int, steps: int, key: Array) -> Batch:
    """The last of 1 to `steps` decisions from each state `start` [b, n]. The key is consumed."""
    acting, moving, choosing, stopping = jax.random.split(key, 4)
    b, n = start.shape
    along = (
        jax.random.normal(acting, (steps, b, m)),
        jax.random.normal(moving, (steps, b, n)),
        jax.random.split(choosing, steps),
        jnp.arange(steps),
    )
    last = jax.random.randint(stopping, (b,), 0, steps)

    def forward(carry: tuple[Array, Batch], at: tuple[Array, ...]) -> tuple:
        x, last_one = carry
        *random, t = at
        new = step(x, *random)
        last_one = where(t == last, new, last_one)
        ended = new.terminated > 0.5  # an ended branch restarts at its first state
        return (where(ended, start, new.next_obs), last_one), None

    shapes = jax.eval_shape(step, start, *(each[0] for each in along[:3]))
    first = start, jax.tree.map(jnp.zeros_like, shapes)
    return jax.lax.scan(forward, first, along, unroll=min(steps, 4))[0][1]
