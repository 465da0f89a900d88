"""What is learned in the models alone: for a new goal, before anything acts; and what to forget."""

from typing import Any, Protocol

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import history
from hybrid_rl.core.batching import where
from hybrid_rl.core.branches import Branches
from hybrid_rl.core.lifting import lifted_spec
from hybrid_rl.core.rollout import predict_members
from hybrid_rl.fields import Count, Natural, NotNegative, Strengths, part
from hybrid_rl.protocols import LearnedPolicy, Reward, Trainable, UniformLearner
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Batch, Params


class Continuing(UniformLearner, Protocol):
    """A learner of policy and critic in a model, which can begin with a policy that has learned."""

    policy: LearnedPolicy
    model: Trainable
    reward: Reward

    def having(self, state: Any, policy: Any) -> Any:
        """`state` with these parameters of its policy."""


@part
class Imagination:
    """A policy goes on learning, for another reward, in the models that it comes with.

    `learner` makes `updates` from states of `walk` decisions that the policy, at its `strengths` in
    turn, makes in the models from first states of episodes. Its critic is new, and learns alone at
    first. Nothing is decided in the world. The policy stays as it was unless the members of the
    ensemble agree that it gained, in episodes of `decisions` that each of them predicts:

        mean_i [J_i(new) - J_i(old)] > doubt std_i [...]

    Source: model-based policy optimisation (Janner et al. 2019) in models that no longer learn; the
    doubt is that of `controllers.gradient`.
    """

    learner: Continuing
    updates: Count = 800
    critic_first: Natural = 200  # of them, in which the policy stays
    starts: Count = 64  # first states
    walk: Count = 100  # decisions from each
    strengths: Strengths = (1.0, 0.8, 0.6, 0.4, 0.2)  # factors on the first policy
    decisions: Count = 200  # of an episode that compares
    episodes: Count = 16  # of these
    doubt: NotNegative = 1.0

    def learned(self, episode: Episode, params: Params, key: Array) -> tuple[Params, Array]:
        """`params` with the policy after the updates, if it gained, and whether it did [].

        The key is consumed.
        """
        resetting, walking, first, updating = jax.random.split(key, 4)
        obs = jax.vmap(episode.reset)(jax.random.split(resetting, self.starts)).obs
        seen, model = history.seen(episode.spec, episode.history), self.learner.model
        first_x = jax.vmap(lambda o: model.lift(params.model, history.first(o, seen.obs)))(obs)
        walked = self.walked(params, first_x, walking)
        spec, size = lifted_spec(model, seen), self.learner.batch_size
        begun = self.learner.having(self.learner.init(first, spec), params.policy)

        def update(state: Any, at: tuple[Array, Array]) -> tuple[Any, None]:
            number, key = at
            drawing, learning = jax.random.split(key)
            rows = jax.random.randint(drawing, (size,), 0, len(walked.reward))
            batch = jax.tree.map(lambda leaf: leaf[rows], walked)
            now = params._replace(**self.learner.params(state))
            after = self.learner.update(state, now, batch, learning)[0]
            frozen = self.learner.having(after, now.policy)
            return where(number < self.critic_first, frozen, after), None

        along = jnp.arange(self.updates), jax.random.split(updating, self.updates)
        state = jax.lax.scan(update, begun, along)[0]
        new = params._replace(policy=self.learner.params(state)["policy"])
        gains = self.returns(new, first_x) - self.returns(params, first_x)
        surely = gains.mean() > self.doubt * gains.std()  # false where one is not finite
        return where(surely, new, params), surely

    def walked(self, params: Params, x: Array, key: Array) -> Batch:
        """Decisions [starts * walk] from x [starts, n] on. The key is consumed."""
        policy, model, reward = self.learner.policy, self.learner.model, self.learner.reward
        strengths = jnp.resize(jnp.array(self.strengths), (len(x), 1))

        def forward(x: Array, key: Array) -> tuple[Array, Batch]:
            acting, moving, choosing = jax.random.split(key, 3)
            mean = policy.mean(params.policy, x)
            noise = jax.random.normal(acting, mean.shape)
            u = strengths * policy.sample(params.policy, x, noise)[0]
            moved = jax.random.normal(moving, x.shape)
            after = model.draw(params.model, x, u, moved, choosing)
            after = where(jnp.isfinite(after).all(-1), after, x)
            r = jax.vmap(reward.outcome, (None, 0, 0, 0))(params, x, u, after)[0]
            return after, Batch(x, u, r, none, none, after)

        keys, none = jax.random.split(key, self.walk), jnp.zeros(len(x))
        rows = jax.lax.scan(forward, x, keys)[1]
        return jax.tree.map(lambda leaf: leaf.reshape(-1, *leaf.shape[2:]), rows)

    def returns(self, params: Params, states: Array) -> Array:
        """The mean return [members] of the policy by each member, from the first of `states`."""
        learner = self.learner

        def one(x: Array, member: Array) -> Array:
            def forward(carry: tuple[Array, Array], _: None) -> tuple[tuple[Array, Array], Array]:
                x, goes_on = carry
                u = learner.policy.mean(params.policy, x)
                after = predict_members(learner.model, params.model, x, u)[2][member]
                r, end = learner.reward.outcome(params, x, u, after)
                return (after, goes_on * jax.nn.sigmoid(-end)), goes_on * r

            return jax.lax.scan(forward, (x, jnp.ones(())), length=self.decisions)[1].sum()

        some = states[: self.episodes]
        u = jnp.zeros_like(learner.policy.mean(params.policy, some[0]))
        members = len(predict_members(learner.model, params.model, some[0], u)[2])
        each = jax.vmap(jax.vmap(one, (0, None)), (None, 0))(some, jnp.arange(members))
        return each.mean(1)


def forgotten(learners: Any) -> Any:
    """States of learners whose branches start again, where they keep some.

    What they imagined in another world, or for another goal, is not what they begin with.
    """

    def one(node: Any) -> Any:
        return node.restarted() if isinstance(node, Branches) else node

    return jax.tree.map(one, learners, is_leaf=lambda node: isinstance(node, Branches))
