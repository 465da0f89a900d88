"""Model-based policy optimisation: any learner, with data imagined by the model.

A share of each batch is replaced: from the first states of the batch the policy acts in the model,

    u ~ pi(x),   x' ~ f(x, u),   r, end = reward(x, u, x'),

for 1 to `steps` decisions, of which the last is used; of an ensemble, f is one member for each
branch, drawn at each step. These are the branched rollouts of Janner et al. 2019 (MBPO), drawn for
each update instead of stored.

With a `memory` the branches are kept from one update to the next: each update continues
`batch_size` branches by one decision, starts those that ended or are `steps` decisions long again
from a state of the batch, and draws its share from the last `memory` imagined transitions. Then
one decision of the model per update is enough for branches of any length, and thus for states that
the present policy leads to.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.core.branching import where
from hybrid_rl.protocols import Policy, Reward, Trainable, UniformLearner
from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class Branches:
    """Branches that go on from one update to the next, and their transitions."""

    x: Array  # [B, n] the states that the branches have reached
    age: Array  # [B] int32 decisions of each branch so far
    rows: Array  # [memory / B, B, width] the last transitions
    count: Array  # [] int32 updates so far


@struct.dataclass
class MBPOState:
    """The state of the learner, and its branches."""

    learner: Any
    branches: Branches | None  # None: none are kept


@dataclass(frozen=True)
class MBPO:
    """`learner` with a `share` of its data imagined by `model`, `reward` and `policy`.

    Raises:
        ValueError: for a share, a number of steps or a memory out of range.
    """

    learner: UniformLearner
    model: Trainable
    reward: Reward
    policy: Policy
    share: float = 0.9
    steps: int = 1  # maximum length of a branch [decisions]
    memory: int = 0  # imagined transitions that are kept; 0: drawn for each update

    data: ClassVar[str] = "uniform"

    def __post_init__(self) -> None:
        """Check the fields."""
        if not 0 <= self.share <= 1:
            raise ValueError(f"mbpo.share={self.share}: must lie in [0, 1]")
        if not isinstance(self.steps, int) or self.steps < 1:
            raise ValueError(f"mbpo.steps={self.steps}: must be a whole number, 1 or more")
        size = self.batch_size
        if self.memory and (self.memory < size or self.memory % size):
            raise ValueError(
                f"mbpo.memory={self.memory}: must be 0 or a multiple of the batch, {size}"
            )

    @property
    def owns(self) -> tuple[str, ...]:
        """The fields of `Params` that `learner` learns."""
        return self.learner.owns

    @property
    def batch_size(self) -> int:
        """Transitions of a batch of `learner`."""
        return self.learner.batch_size

    @property
    def batches(self) -> int:
        """Batches of one update of `learner`."""
        return self.learner.batches

    @property
    def early(self) -> bool:
        """Whether `learner` also learns while decisions are random."""
        return self.learner.early

    @property
    def updates(self) -> float:
        """Updates of `learner` per decision."""
        return self.learner.updates

    def init(self, key: Array, spec: Spec) -> MBPOState:
        """The initial state of `learner`, without branches. The key is consumed."""
        learner = self.learner.init(key, spec)
        if not self.memory:
            return MBPOState(learner, None)
        size, width = self.batch_size, 2 * spec.n + spec.act + 2
        branches = Branches(
            jnp.zeros((size, spec.n)),
            jnp.full(size, self.steps, jnp.int32),
            jnp.zeros((self.memory // size, size, width)),
            jnp.zeros((), jnp.int32),
        )
        return MBPOState(learner, branches)

    def params(self, state: MBPOState) -> dict[str, Any]:
        """The fields of `Params` that `learner` owns."""
        return self.learner.params(state.learner)

    def update(
        self, state: MBPOState, params: Params, batch: Batch, key: Array
    ) -> tuple[MBPOState, dict[str, Array]]:
        """One update of `learner` on the mixed batch. The key is consumed."""
        count, branches = round(self.share * self.batch_size), state.branches
        if count:
            imagine_key, key = jax.random.split(key)
            batch = batch._replace(next_action=None)
            if branches is None:
                imagined = self._imagine(params, batch.obs[:count], imagine_key)
            else:
                going_on, recalling = jax.random.split(imagine_key)
                branches = self._continued(branches, params, batch, going_on)
                imagined = self._recalled(branches, batch, count, recalling)
            batch = jax.tree.map(
                lambda new, old: jnp.concatenate([new, old[count:]]), imagined, batch
            )
        learner, metrics = self.learner.update(state.learner, params, batch, key)
        return MBPOState(learner, branches), metrics

    def _continued(self, state: Branches, params: Params, batch: Batch, key: Array) -> Branches:
        """The branches one decision later, with their transitions in the memory.

        At the first update the branches start at different ages, so that later a part of them
        restarts at each update.
        """
        acting, moving, choosing, aging = jax.random.split(key, 4)
        x, age = batch.obs, jnp.zeros_like(state.age)
        first = jax.random.randint(aging, age.shape, 0, self.steps)
        fresh = state.age >= self.steps
        age = jnp.where(fresh, jnp.where(state.count == 0, first, age), state.age)
        x = where(fresh, x, state.x)
        for_policy = jax.random.normal(acting, batch.action.shape)
        for_model = jax.random.normal(moving, x.shape)
        new = self._transitions(params, x, for_policy, for_model, choosing)
        flags = jnp.stack([new.reward, new.terminated], -1)
        rows = jnp.concatenate([new.obs, new.action, flags, new.next_obs], -1)
        slot = state.count % len(state.rows)
        age = jnp.where(new.terminated > 0.5, self.steps, age + 1)
        return state.replace(
            x=new.next_obs,
            age=age,
            rows=jax.lax.dynamic_update_index_in_dim(state.rows, rows, slot, 0),
            count=state.count + 1,
        )

    def _recalled(self, state: Branches, like: Batch, count: int, key: Array) -> Batch:
        """`count` imagined transitions, uniform over the memory. The key is consumed."""
        length, size, width = state.rows.shape
        known = jnp.minimum(state.count, length) * size
        rows = state.rows.reshape(-1, width)[jax.random.randint(key, (count,), 0, known)]
        n, m = like.obs.shape[1], like.action.shape[1]
        x, u, flags, after = jnp.split(rows, (n, n + m, n + m + 2), axis=1)
        return Batch(x, u, flags[:, 0], flags[:, 1], jnp.zeros(count), after)

    def _imagine(self, params: Params, x: Array, key: Array) -> Batch:
        """One imagined transition for each of the states x [b, n]."""
        acting, moving, choosing, stopping = jax.random.split(key, 4)
        m = jax.eval_shape(self.policy.mean, params.policy, x[0]).shape[-1]
        length, (b, n) = self.steps, x.shape
        along = (
            jax.random.normal(acting, (length, b, m)),
            jax.random.normal(moving, (length, b, n)),
            jax.random.split(choosing, length),
            jnp.arange(length),
        )
        last = jax.random.randint(stopping, (b,), 0, length)

        def forward(carry: tuple[Array, Batch], at: tuple[Array, ...]) -> tuple:
            x, last_one = carry
            *random, t = at
            new = self._transitions(params, x, *random)
            last_one = where(t == last, new, last_one)
            ended = new.terminated > 0.5  # an ended branch restarts at its first state
            return (where(ended, start, new.next_obs), last_one), None

        start = x
        empty = jax.tree.map(
            lambda s: jnp.zeros(s.shape, s.dtype),
            jax.eval_shape(self._transitions, params, x, *(each[0] for each in along[:3])),
        )
        return jax.lax.scan(forward, (x, empty), along, unroll=min(length, 4))[0][1]

    def _transitions(
        self, params: Params, x: Array, for_policy: Array, for_model: Array, key: Array
    ) -> Batch:
        """One transition from each x [b, n]; its `terminated` is a probability."""
        u = jax.vmap(self.policy.sample, (None, 0, 0))(params.policy, x, for_policy)[0]
        after = self.model.draw(params.model, x, u, for_model, key)
        outcome = jax.vmap(self.reward.outcome, (None, 0, 0, 0))
        reward, end = outcome(params, x, u, after)
        return Batch(x, u, reward, jax.nn.sigmoid(end), jnp.zeros(len(x)), after)
