"""Model-based policy optimisation: any learner, with data imagined by the model.

A fraction of each batch is replaced: from the first states of the batch the policy acts in the
model for 1 to `steps` decisions, of which the last is used; of an ensemble, the model is one member
for each branch, drawn at each step. These are the branched rollouts of Janner et al. 2019 (MBPO),
drawn for each update instead of stored.
"""

from functools import partial
from operator import attrgetter
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import branches
from hybrid_rl.fields import Count, Fraction, part
from hybrid_rl.protocols import Policy, Reward, Trainable, UniformLearner
from hybrid_rl.types import Batch, Params, Spec


@part
class MBPO:
    """`learner` with data imagined by `model`, `reward` and `policy`."""

    learner: UniformLearner
    model: Trainable
    reward: Reward
    policy: Policy
    imagined_fraction: Fraction = 0.9
    steps: Count = 1  # maximum length of a branch [decisions]

    data: ClassVar[str] = "uniform"

    # as `learner` has them
    owns = property(attrgetter("learner.owns"))
    batch_size = property(attrgetter("learner.batch_size"))
    batches = property(attrgetter("learner.batches"))
    during_random = property(attrgetter("learner.during_random"))
    updates = property(attrgetter("learner.updates"))

    def init(self, key: Array, spec: Spec) -> Any:
        """The initial state of `learner`. The key is consumed."""
        return self.learner.init(key, spec)

    def params(self, state: Any) -> dict[str, Any]:
        """The fields of `Params` that `learner` owns."""
        return self.learner.params(state)

    def update(
        self, state: Any, params: Params, batch: Batch, key: Array
    ) -> tuple[Any, dict[str, Array]]:
        """One update of `learner` on the mixed batch. The key is consumed."""
        count = round(self.imagined_fraction * self.batch_size)
        if count:
            drawing, key = jax.random.split(key)
            draw = partial(self.model.draw, params.model)
            step = branches.transitions(params, self.policy, draw, self.reward)
            m, start = batch.action.shape[-1], batch.obs[:count]
            imagined = branches.sample_fresh(step, start, m, self.steps, drawing)
            batch = jax.tree.map(
                lambda new, old: jnp.concatenate([new, old[count:]]),
                imagined,
                batch._replace(next_action=None),
            )
        return self.learner.update(state, params, batch, key)
