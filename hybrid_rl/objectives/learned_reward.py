"""J(path) = sum_t c_t r(x_t, u_t) [+ c_T min_i Q_i(x_T, pi(x_T))]: the return that was learned.

c_t is the discount so far, times the chance that the episode goes on where `ends` learns it from
where episodes end: else a planner expects a robot that fell to go on earning.

r is a network (thesis appendix B: two layers of 200). Its loss is
0.5 (r + c (1 - end) r(x', u') - r(x, u))^2 with u' the action that was executed at x'; c = 0 makes
r a reward, c = 0.95 makes it the thesis' value-like utility, which the planner then sums once more.
The term of x' is left out where an episode ended, at a time limit too, although the task would go
on there: nothing was executed at its last state, so u' is unknown.
"""

from dataclasses import dataclass, replace
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.networks import MLP, check
from hybrid_rl.types import Params, Path, Policy, Spec


@dataclass(frozen=True)
class LearnedReward:
    """A reward network, and the return of a path under it.

    Raises:
        ValueError: for widths or activations that make no network, or a half-given terminal.
    """

    hidden: tuple[int, ...] = (200, 200)
    activation: str = "relu"
    normalise: bool = True
    ends: bool = False  # learn where episodes end, after which nothing is earned
    discount: float = 1.0  # of imagined rewards, per decision
    critic: Any = None  # with `policy`: adds the critic's value of the last state
    policy: Policy | None = None

    def __post_init__(self) -> None:
        """Check the fields."""
        object.__setattr__(self, "hidden", tuple(self.hidden))
        check("objective", self.hidden, self.activation)
        if (self.critic is None) != (self.policy is None):
            raise ValueError("objective.critic and objective.policy: give both or neither")
        if not 0 < self.discount <= 1:
            raise ValueError(f"objective.discount={self.discount}: must lie in (0, 1]")

    def _net(self) -> MLP:
        return MLP(self.hidden, 1 + self.ends, self.activation)

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Weights, and the statistics that they are relative to. The key is consumed."""
        return {
            "weights": self._net().init(key, jnp.zeros(spec.obs + spec.act)),
            "state": statistics.init(spec.obs),
        }

    def observe(self, params: dict[str, Any], x: Array) -> dict[str, Any]:
        """Parameters whose statistics have seen x [B, n]."""
        if not self.normalise:
            return params
        return {**params, "state": statistics.update(params["state"], x)}

    def outcome(self, params: dict[str, Any], x: Array, u: Array) -> tuple[Array, Array]:
        """Of u [m] at x [n]: the reward [], and the logit [] of the chance that it ends there."""
        inputs = jnp.concatenate([statistics.normalise(params["state"], x), u])
        out: Any = self._net().apply(params["weights"], inputs)
        return out[0], out[1] if self.ends else -jnp.inf

    def reward(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """R [] at x [n] and u [m]."""
        return self.outcome(params, x, u)[0]

    def loss(
        self, params: dict[str, Any], x: Array, u: Array, target: Array, ended: Array
    ) -> Array:
        """Half the squared error [] against target [], and the cross entropy of `ended` []."""
        r, logit = self.outcome(params, x, u)
        error = 0.5 * (target - r) ** 2
        return error + jax.nn.softplus(logit) - ended * logit if self.ends else error

    def begin(self, spec: Spec) -> tuple[()]:
        """Nothing: what was earned earlier changes no decision."""
        return ()

    def look(self, params: Params, memory: tuple[()], x: Array, key: Array) -> tuple[()]:
        """Still nothing."""
        return memory

    def value(self, params: Params, memory: tuple[()], path: Path) -> Array:
        """J [] of `path`."""
        return self.reward_to_go(params, path)[0]

    def rewards(self, params: Params, path: Path) -> Array:
        """r [T] along path, x [T+1, n] and u [T, m]."""
        return jax.vmap(self.reward, (None, 0, 0))(params.reward, path.x[:-1], path.u)

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1] along path, x [T+1, n] and u [T, m]; S[T] is the value of the last state."""
        rate = jax.vmap(self.outcome, (None, 0, 0))
        rewards, ends = rate(params.reward, path.x[:-1], path.u)
        last = jnp.zeros(())
        if self.critic is not None and self.policy is not None:
            x = path.x[-1]
            last = self.critic.value(params.critic, x, self.policy.mean(params.policy, x))

        def back(after: Array, at: tuple[Array, Array]) -> tuple[Array, Array]:
            r, end = at
            now = r + self.discount * jax.nn.sigmoid(-end) * after
            return now, now

        to_go = jax.lax.scan(back, last, (rewards, ends), reverse=True, unroll=True)[1]
        return jnp.append(to_go, last)


def without_critic(objective: Any) -> Any:
    """`objective` by what the model imagines alone: nothing closes its horizon.

    Other objectives than `LearnedReward`, which have no critic to leave out, stay as they are.
    """
    if not isinstance(objective, LearnedReward):
        return objective
    return replace(objective, critic=None, policy=None)
