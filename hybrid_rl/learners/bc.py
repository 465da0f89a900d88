"""Behaviour cloning (thesis appendix B and Algorithm 8, line 12).

    loss = -mean log pi(u | x),   (x, u) only from demonstrations

With `average` the policy that acts has the running mean of the learned weights w (Polyak and
Juditsky 1992, with exponential weights):

    w_bar += average (w - w_bar)   after every gradient step; w_bar = w at first

The decay of weights is AdamW's (Loshchilov and Hutter 2019). The batch of experience is not used.
Actions are clipped to [-edge, edge], since the density of a squashed Gaussian is unbounded at -1
and 1.
"""

from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.core.decay import adamw
from hybrid_rl.core.lifting import lift
from hybrid_rl.fields import Count, Inside, NotNegative, Positive, Share, part
from hybrid_rl.protocols import Demonstrations, LearnedPolicy, Model
from hybrid_rl.types import Batch, Params, PyTree, Spec


@struct.dataclass
class CloningState:
    """The state of behaviour cloning."""

    policy: Any  # what the gradient steps change
    optimiser: Any
    average: PyTree = None  # of `policy` over the steps; None: `policy` itself acts


@part
class BehaviourCloning:
    """Gradient steps on the log-likelihood of demonstrated actions.

    Without `demonstrations` it only holds the parameters of a trained policy.
    """

    policy: LearnedPolicy
    demonstrations: Demonstrations | None
    model: Model | None = None  # lifts the demonstrations to planning states; None: as they are
    learning_rate: Positive = 3e-3
    edge: Inside = 0.99  # bound of the imitated actions
    batch_size: Count = 128
    updates: float = 0.25  # per decision
    weight_decay: NotNegative = 0.0  # of the layers' matrices, per unit of learning rate
    average: Share | None = None  # share of the new weights in the mean that acts; None: no mean

    data: ClassVar[str] = "uniform"
    owns: ClassVar[tuple[str, ...]] = ("policy",)
    batches: ClassVar[int] = 1
    during_random: ClassVar[bool] = False  # starts after the random decisions

    def init(self, key: Array, spec: Spec) -> CloningState:
        """Initial parameters and optimiser. The key is consumed."""
        policy = self.policy.init(key, spec)
        if self.demonstrations is not None:
            model = None if self.model is None else self.model.init(key, spec)
            x = self._states(model, self.demonstrations.load().obs)
            policy = self.policy.observe(policy, x)
        average = None if self.average is None else policy
        return CloningState(policy, self._optimiser().init(policy), average)

    def _optimiser(self) -> optax.GradientTransformation:
        return adamw(self.learning_rate, self.weight_decay)

    def _states(self, model: Any, obs: Any) -> Array:
        """Planning states [B, n] of observations [B, o] with model parameters `model`."""
        return jax.vmap(lambda obs: lift(self.model, model, obs))(jnp.asarray(obs))

    def params(self, state: CloningState) -> dict[str, Any]:
        """The policy that acts."""
        return {"policy": state.policy if self.average is None else state.average}

    def update(
        self, state: CloningState, params: Params, batch: Batch, key: Array
    ) -> tuple[CloningState, dict[str, Array]]:
        """One Adam step on `batch_size` demonstrated decisions. The key is consumed."""
        assert self.demonstrations is not None
        demonstrated = self.demonstrations.load()
        drawn = jax.random.randint(key, (self.batch_size,), 0, len(demonstrated.reward))
        x = self._states(params.model, jnp.asarray(demonstrated.obs)[drawn])
        u = jnp.clip(jnp.asarray(demonstrated.action)[drawn], -self.edge, self.edge)

        def loss(policy: Any) -> Array:
            return -self.policy.log_prob(policy, x, u).mean()

        value, grads = jax.value_and_grad(loss)(state.policy)
        change, optimiser = self._optimiser().update(grads, state.optimiser, state.policy)
        policy, average = optax.apply_updates(state.policy, change), None
        if self.average is not None:
            average = optax.incremental_update(policy, state.average, self.average)
        return CloningState(policy, optimiser, average), {"bc/policy_loss": value}
