"""Deep deterministic policy gradients (Lillicrap et al. 2016; thesis eq. 6.26).

    y    = r + gamma (1 - terminated) Q'(x', pi'(x'))
    L_Q  = 0.5 sum_i mean (Q_i(x, u) - y)^2,   L_pi = -mean Q(x, pi(x))
    Q'   <- (1 - tau) Q' + tau Q,              pi'  <- (1 - tau) pi' + tau pi

pi is the mean of any policy; the controller explores. Q is the minimum over the critic's members;
the original has one. A time limit does not terminate the task.
"""

from functools import partial
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.core import decay, statistics
from hybrid_rl.core import soft_actor_critic as steps
from hybrid_rl.fields import Count, Discount, Positive, Share, part
from hybrid_rl.protocols import Critic, LearnedPolicy, Schedule
from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class DDPGState:
    """The state of DDPG."""

    policy: Any
    critic: Any
    target_policy: Any
    target_critic: Any
    policy_optimiser: Any
    critic_optimiser: Any


@part
class DDPG:
    """Deterministic policy gradients on the mean of a policy and a critic."""

    policy: LearnedPolicy
    critic: Critic
    policy_learning_rate: Positive = 1e-4
    critic_learning_rate: Positive = 1e-3
    discount: Discount = 0.99
    tau: Share = 0.01
    batch_size: Count = 128
    updates: float = 1  # per decision
    schedule: Schedule | None = None  # of the learning rates

    data: ClassVar[str] = "uniform"
    owns: ClassVar[tuple[str, ...]] = ("policy", "critic")
    batches: ClassVar[int] = 1
    during_random: ClassVar[bool] = False  # starts after the random decisions

    def init(self, key: Array, spec: Spec) -> DDPGState:
        """Initial parameters, optimisers and targets. The key is consumed."""
        for_policy, for_critic = jax.random.split(key)
        policy, critic = self.policy.init(for_policy, spec), self.critic.init(for_critic, spec)
        return DDPGState(
            policy,
            critic,
            jax.tree.map(jnp.copy, policy),
            jax.tree.map(jnp.copy, critic),
            optax.adam(self.policy_learning_rate).init(policy),
            optax.adam(self.critic_learning_rate).init(critic),
        )

    def params(self, state: DDPGState) -> dict[str, Any]:
        """The policy and the critic."""
        return {"policy": state.policy, "critic": state.critic}

    def update(
        self, state: DDPGState, params: Params, batch: Batch, key: Array
    ) -> tuple[DDPGState, dict[str, Array]]:
        """One step of critic, policy and targets."""
        factor = decay.of_rates(self.schedule, params.decisions)
        state = steps.observed(self, state, batch)
        after = self.critic.value(
            state.target_critic,
            batch.next_obs,
            self.policy.mean(state.target_policy, batch.next_obs),
        )
        y = batch.reward + self.discount * (1 - batch.terminated) * after
        state, (of_critic, q) = steps.critic_step(
            self, state, batch.obs, batch.action, y, factor=factor
        )

        def loss(policy: Any) -> tuple[Array, None]:
            u = self.policy.mean(policy, batch.obs)
            return -jnp.mean(self.critic.value(state.critic, batch.obs, u)), None

        state, (of_policy, *_) = steps.policy_step(self, state, loss, factor=factor)
        metrics = {"ddpg/critic_loss": of_critic, "ddpg/policy_loss": of_policy, "ddpg/q": q}
        update = partial(statistics.soft_target_update, tau=self.tau)
        policy = update(state.target_policy, state.policy)
        critic = update(state.target_critic, state.critic)
        return state.replace(target_policy=policy, target_critic=critic), metrics
