"""The return of a reward along a path, discounted; the reward is learned or known.

    J(path) = sum_t c_t r(x_t, u_t, x_{t+1}) [+ c_T min_i Q_i(x_T, pi(x_T))]

c_t is the discount so far, times the probability that the episode continues if the reward predicts
it: without it a planner expects rewards after a robot has fallen.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import returns
from hybrid_rl.core.lifting import policy_input
from hybrid_rl.fields import Share, part
from hybrid_rl.protocols import Critic, Policy, Reward
from hybrid_rl.types import Params, Path, Return, Spec


@part
class PredictedReturn:
    """The discounted sum of `reward` along a path, plus the critic's value of the last state."""

    reward: Reward
    discount: Share = 1.0  # per decision
    critic: Critic | None = None  # with `policy`: adds the value of the last state
    policy: Policy | None = None

    def init(self, spec: Spec) -> tuple[()]:
        """No memory: earlier rewards do not affect decisions."""
        return ()

    def prepare(
        self, params: Params, memory: tuple[()], x: Array, u_before: Array, key: Array
    ) -> tuple[Return, tuple[()]]:
        """J of a path; the key is not used."""
        return lambda path: self.reward_to_go(params, path)[0], memory

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1] along path, x [T+1, n] and u [T, m]; S[T] is the value of the last state."""
        before = jax.tree.map(lambda leaf: leaf[:-1], path.x)
        after = jax.tree.map(lambda leaf: leaf[1:], path.x)
        each = jax.vmap(self.reward.outcome, (None, 0, 0, 0))
        rewards, ends = each(params, before, path.u, after)  # [T] each
        last = jnp.zeros(())
        if self.critic is not None:
            assert self.policy is not None
            x = policy_input(jax.tree.map(lambda leaf: leaf[-1], path.x))
            last = self.critic.value(params.critic, x, self.policy.mean(params.policy, x))
        goes_on = self.discount * jax.nn.sigmoid(-ends)
        return returns.to_go(rewards, goes_on, last, unroll=True)
