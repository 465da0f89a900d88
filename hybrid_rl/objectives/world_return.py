"""J(path) = sum_t c^t r_t [+ c^T min_i Q_i(o_T, pi(o_T))]: the rewards that the world itself pays.

For paths of the world's own states (`model=world`); after the end of an episode nothing is paid.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.protocols import Critic, Policy
from hybrid_rl.types import Params, Path, Return, Spec


@dataclass(frozen=True)
class WorldReturn:
    """The discounted sum of a path's rewards, plus the critic's value of the last state.

    Raises:
        ValueError: for a critic without a policy or the reverse, or a discount outside (0, 1].
    """

    discount: float = 1.0  # c, per decision
    critic: Critic | None = None  # with `policy`: adds the value of the last state
    policy: Policy | None = None

    def __post_init__(self) -> None:
        """Check the fields."""
        if (self.critic is None) != (self.policy is None):
            raise ValueError("objective.critic and objective.policy: give both or neither")
        if not 0 < self.discount <= 1:
            raise ValueError(f"objective.discount={self.discount}: must lie in (0, 1]")

    def init(self, spec: Spec) -> tuple[()]:
        """No memory."""
        return ()

    def prepare(
        self, params: Params, memory: tuple[()], x: Array, u_before: Array, key: Array
    ) -> tuple[Return, tuple[()]]:
        """J of a path; the key is not used."""
        return lambda path: self.reward_to_go(params, path)[0], memory

    def rewards(self, params: Params, path: Path) -> Array:
        """r [T] of each decision of the path, whose x is an EnvState [T+1, ...]."""
        return jnp.where(path.x.done[:-1], 0.0, path.x.reward[1:])

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1] along the path; S[T] is the value of the last state."""
        last = jnp.zeros(())
        if self.critic is not None and self.policy is not None:
            o = path.x.obs[-1]
            value = self.critic.value(params.critic, o, self.policy.mean(params.policy, o))
            last = jnp.where(path.x.terminated[-1], 0.0, value)

        def back(after: Array, r: Array) -> tuple[Array, Array]:
            now = r + self.discount * after
            return now, now

        to_go = jax.lax.scan(back, last, self.rewards(params, path), reverse=True)[1]
        return jnp.append(to_go, last)
