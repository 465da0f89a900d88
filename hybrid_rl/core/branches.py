"""Branches: trajectories of a policy in a model that begin at real states (Janner et al. 2019).

`sample_fresh` draws them for each update. `Branches` are kept from one update to the next: each
update continues all of them by one decision and restarts those that ended or reached their length.
Then one decision of the model per update is enough for branches of any length, and thus for states
that the present policy leads to.
"""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.core.batching import repeat, where
from hybrid_rl.core.statistics import FLOOR
from hybrid_rl.protocols import Policy, Reward
from hybrid_rl.types import Batch, Params

Transitions = Callable[[Array, Array, Array, Array], Batch]
"""x [b, n], noise [b, m] and [b, n], key -> a transition from each x."""
Draw = Callable[[Array, Array, Array, Array], Array]
"""x [b, n], u [b, m], noise [b, n], key -> next states [b, n]."""


@struct.dataclass
class Branches:
    """B branches and the ring of their transitions."""

    x: Array  # [B, n] the states that the branches have reached
    age: Array  # [B] int32 decisions of each branch so far
    rows: Batch  # [memory / B, B, ...] the last transitions; None: what is not used
    count: Array  # [] int32 updates so far

    def restarted(self) -> "Branches":
        """All start again at the next update, without the old transitions."""
        ended = jnp.full_like(self.age, jnp.iinfo(self.age.dtype).max)
        return self.replace(age=ended, count=jnp.zeros_like(self.count))


def transitions(params: Params, policy: Policy, draw: Draw, reward: Reward) -> Transitions:
    """u ~ pi(x), x' ~ f(x, u) and r, end = reward(x, u, x'); `terminated` is a probability."""

    def one(x: Array, for_policy: Array, for_model: Array, key: Array) -> Batch:
        u = jax.vmap(policy.sample, (None, 0, 0))(params.policy, x, for_policy)[0]
        after = draw(x, u, for_model, key)
        r, end = jax.vmap(reward.outcome, (None, 0, 0, 0))(params, x, u, after)
        return Batch(x, u, r, jax.nn.sigmoid(end), jnp.zeros(len(x)), after)

    return one


def begin(size: int, memory: int, n: int, m: int, steps: int, whole: bool = True) -> Branches:
    """`size` branches that are to start at the next update; memory: transitions.

    whole: false keeps the states and rewards of transitions alone.
    """
    x, none = jnp.zeros((size, n)), jnp.zeros(size)
    row = _kept(Batch(x, jnp.zeros((size, m)), none, none, none, x), whole)
    rows = jax.tree.map(lambda leaf: repeat(leaf, memory // size), row)
    return Branches(x, jnp.full(size, steps, jnp.int32), rows, jnp.zeros((), jnp.int32))


def _kept(batch: Batch, whole: bool) -> Batch:
    """What the ring keeps of transitions."""
    nothing: dict[str, Any] = dict.fromkeys(("action", "terminated", "truncated", "next_obs"))
    return batch if whole else batch._replace(**nothing)


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
    slot = branches.count % len(branches.rows.obs)
    rows = jax.tree.map(
        lambda ring, new: jax.lax.dynamic_update_index_in_dim(ring, new, slot, 0),
        branches.rows,
        _kept(made, branches.rows.action is not None),
    )
    ended = made.terminated > 0.5
    if margin is not None:
        ended |= _far(made.next_obs, start, margin)
    age = jnp.where(ended, steps, age + 1)
    return Branches(made.next_obs, age, rows, branches.count + 1)


def _far(x: Array, real: Array, margin: float) -> Array:
    """Whether states x [B, n] leave the range of `real` [b, n], widened on both sides: [B].

    Entries that are constant in `real`, to float32's precision, do not count.
    """
    low, high = real.min(0, keepdims=True), real.max(0, keepdims=True)
    wide = high - low
    varies = wide > FLOOR * jnp.maximum(jnp.abs(low), jnp.abs(high))
    outside = (x < low - margin * wide) | (x > high + margin * wide)
    return (outside & varies).any(-1)


def sample_kept(branches: Branches, key: Array) -> Batch:
    """B transitions, uniform over those that are kept. The key is consumed."""
    length, size = branches.rows.reward.shape
    known = jnp.minimum(branches.count, length) * size
    index = jax.random.randint(key, (size,), 0, known)
    return jax.tree.map(lambda ring: ring.reshape(-1, *ring.shape[2:])[index], branches.rows)


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
