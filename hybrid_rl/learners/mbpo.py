"""Model-based policy optimisation: any learner, with data imagined by the model.

A share of each batch is replaced: from the first states of the batch the policy acts in the model,

    u ~ pi(x),   x' ~ f(x, u),   r, end = reward(x, u),

for 1 to `steps` decisions, of which the last is used; of an ensemble, f is one member for each
branch, drawn at each step. These are the branched rollouts of Janner et al. 2019 (MBPO), drawn for
each update instead of stored.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.lifting import lifted_batch, lifted_spec
from hybrid_rl.protocols import Policy, Reward, Trainable, UniformLearner
from hybrid_rl.types import Batch, Params, Spec


@dataclass(frozen=True)
class MBPO:
    """`learner` with a `share` of its data imagined by `model`, `reward` and `policy`.

    It lifts the observations: the learner gets planning states and needs no model itself.

    Raises:
        ValueError: for a share or a number of steps out of range.
    """

    learner: UniformLearner
    model: Trainable
    reward: Reward
    policy: Policy
    share: float = 0.9
    steps: int = 1  # maximum length of a branch [decisions]

    data: ClassVar[str] = "uniform"

    def __post_init__(self) -> None:
        """Check the fields."""
        if not 0 <= self.share <= 1:
            raise ValueError(f"mbpo.share={self.share}: must lie in [0, 1]")
        if not isinstance(self.steps, int) or self.steps < 1:
            raise ValueError(f"mbpo.steps={self.steps}: must be a whole number, 1 or more")

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

    def init(self, key: Array, spec: Spec) -> Any:
        """The initial state of `learner`. The key is consumed."""
        return self.learner.init(key, lifted_spec(self.model, spec))

    def params(self, state: Any) -> dict[str, Any]:
        """The fields of `Params` that `learner` owns."""
        return self.learner.params(state)

    def update(
        self, state: Any, params: Params, batch: Batch, key: Array
    ) -> tuple[Any, dict[str, Array]]:
        """One update of `learner` on the mixed batch. The key is consumed."""
        batch = lifted_batch(self.model, params.model, batch)
        count = round(self.share * self.batch_size)
        if not count:
            return self.learner.update(state, params, batch, key)
        imagine_key, update_key = jax.random.split(key)
        imagined = self._imagine(params, batch.obs[:count], imagine_key)
        batch = batch._replace(next_action=None)
        batch = jax.tree.map(lambda new, old: jnp.concatenate([new, old[count:]]), imagined, batch)
        return self.learner.update(state, params, batch, update_key)

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
            last_one = jax.tree.map(lambda a, b: _where(t == last, a, b), new, last_one)
            ended = new.terminated > 0.5  # an ended branch restarts at its first state
            return (_where(ended, start, new.next_obs), last_one), None

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
        reward, end = jax.vmap(self.reward.outcome, (None, 0, 0))(params.reward, x, u)
        return Batch(x, u, reward, jax.nn.sigmoid(end), jnp.zeros(len(x)), after)


def _where(flags: Array, a: Array, b: Array) -> Array:
    """Entries of a [b, ...] where flags [b] are true, else of b."""
    return jnp.where(flags.reshape(flags.shape + (1,) * (a.ndim - 1)), a, b)
