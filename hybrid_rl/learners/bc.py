"""Behaviour cloning (thesis appendix B and Algorithm 8, line 12).

    loss = -mean log pi(u | x),   (x, u) from demonstrations alone

What the world pays, and what the learner itself did there, does not enter: the batch of
experience is left aside. Actions at the edge of [-1, 1], where a squashed density has no bound,
are taken as `edge`.
"""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class CloningState:
    """What behaviour cloning carries."""

    policy: Any
    optimiser: Any


@dataclass(frozen=True)
class BehaviourCloning:
    """Gradient steps on a policy that offers `log_prob`, from what `demonstrations` recalls.

    Without `demonstrations` it holds a learned policy, and cannot be updated.

    Raises:
        ValueError: for a rate or an edge out of range.
    """

    policy: Any
    demonstrations: Any
    learning_rate: float = 3e-3
    edge: float = 0.99  # greatest action that is imitated
    batch_size: int = 128
    updates: float = 0.25  # per decision

    batches = 1
    early = False  # it waits for the end of random decisions

    def __post_init__(self) -> None:
        """Check the fields."""
        if self.learning_rate <= 0:
            raise ValueError(f"cloning_learner.learning_rate={self.learning_rate}: must be above 0")
        if not 0 < self.edge < 1:
            raise ValueError(f"cloning_learner.edge={self.edge}: must lie in (0, 1)")

    def init(self, key: Array, spec: Spec) -> CloningState:
        """First parameters and optimiser. The key is consumed."""
        policy = self.policy.init(key, spec)
        if self.demonstrations is not None:
            policy = self.policy.observe(policy, jnp.asarray(self.demonstrations.recall().obs))
        return CloningState(policy, optax.adam(self.learning_rate).init(policy))

    def params(self, state: CloningState) -> dict[str, Any]:
        """The policy."""
        return {"policy": state.policy}

    def update(
        self, state: CloningState, params: Params, batch: Batch, key: Array
    ) -> tuple[CloningState, dict[str, Array]]:
        """One Adam step on `batch_size` demonstrated decisions. The key is consumed."""
        shown = self.demonstrations.recall()
        drawn = jax.random.randint(key, (self.batch_size,), 0, len(shown.reward))
        x = jnp.asarray(shown.obs)[drawn]
        u = jnp.clip(jnp.asarray(shown.action)[drawn], -self.edge, self.edge)

        def loss(policy: Any) -> Array:
            return -self.policy.log_prob(policy, x, u).mean()

        value, grads = jax.value_and_grad(loss)(state.policy)
        adam = optax.adam(self.learning_rate)
        change, optimiser = adam.update(grads, state.optimiser, state.policy)
        new = CloningState(optax.apply_updates(state.policy, change), optimiser)
        return new, {"bc/policy_loss": value}
