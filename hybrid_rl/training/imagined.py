"""What is learned in the models alone: for a new goal, before anything acts; and what to forget."""

from typing import Any, Protocol

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.branches import Branches
from hybrid_rl.core.branching import where
from hybrid_rl.core.lifting import lifted_spec
from hybrid_rl.fields import Count, Natural, part
from hybrid_rl.protocols import Model, UniformLearner
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Batch, Params


class Continuing(UniformLearner, Protocol):
    """A learner of policy and critic that can begin with a policy that has learned already."""

    def having(self, state: Any, policy: Any) -> Any:
        """`state` with these parameters of its policy."""


@part
class Imagination:
    """A policy goes on learning, for another reward, in the models that it comes with.

    `learner` makes `updates` from first states of episodes, whose branches the present policy
    continues in the models (`core.branches`); its critic is new, and learns alone at first.
    Nothing is decided in the world. Source: model-based policy optimisation (Janner et al. 2019),
    with a model that no longer learns.

    Raises:
        ValueError: for counts out of range.
    """

    learner: Continuing
    model: Model
    updates: Count = 1000
    critic_first: Natural = 200  # of them, in which the policy stays
    starts: Count = 1024  # first states

    def learned(self, episode: Episode, params: Params, key: Array) -> Params:
        """`params` with the policy and the critic after the updates. The key is consumed.

        The policy stays as it was if it does not stay finite.
        """
        resetting, first, updating = jax.random.split(key, 3)
        obs = jax.vmap(episode.reset)(jax.random.split(resetting, self.starts)).obs
        states = jax.vmap(self.model.lift, (None, 0))(params.model, obs)
        spec, size = lifted_spec(self.model, episode.spec), self.learner.batch_size
        begun = self.learner.having(self.learner.init(first, spec), params.policy)

        def update(state: Any, at: tuple[Array, Array]) -> tuple[Any, None]:
            number, key = at
            drawing, learning = jax.random.split(key)
            x = states[jax.random.randint(drawing, (size,), 0, self.starts)]
            none = jnp.zeros(size)
            batch = Batch(x, jnp.zeros((size, spec.act)), none, none, none, x)
            now = params._replace(**self.learner.params(state))
            after = self.learner.update(state, now, batch, learning)[0]
            frozen = self.learner.having(after, now.policy)
            return where(number < self.critic_first, frozen, after), None

        along = jnp.arange(self.updates), jax.random.split(updating, self.updates)
        found = params._replace(**self.learner.params(jax.lax.scan(update, begun, along)[0]))
        sound = [jnp.isfinite(leaf).all() for leaf in jax.tree.leaves(found)]
        return where(jnp.stack(sound).all(), found, params._replace(critic=found.critic))


def forgotten(learners: Any) -> Any:
    """States of learners whose branches start again, where they keep some.

    What they imagined in another world, or for another goal, is not what they begin with.
    """

    def one(node: Any) -> Any:
        return node.restarted() if isinstance(node, Branches) else node

    return jax.tree.map(one, learners, is_leaf=lambda node: isinstance(node, Branches))
