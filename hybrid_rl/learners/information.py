"""The Fisher information of the data so far about a learned model's weights theta [P].

    I_j = N mean_i |F_ij|^2 / sigma^2,   F = df / dtheta at a transition i of the replay memory

N is the number of decisions before the present ones. The mean is a running one over batches, since
theta changes; its oldest batches, about 1 / `rate` of them, also had an older unit of the change,
the model's running deviation. The model is fitted to one-step transitions, so F is the derivative
by step (core/fisher.py).
"""

from typing import Any, ClassVar

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array
from jax.flatten_util import ravel_pytree

from hybrid_rl.core import fisher
from hybrid_rl.fields import Count, Positive, Share, part
from hybrid_rl.networks import mean_weights, precision
from hybrid_rl.protocols import Model
from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class InformationState:
    """The diagonal of the information."""

    mean: Array  # [P] of one decision
    decisions: Array  # []
    batches: Array  # []

    @property
    def total(self) -> Array:
        """[P] of all decisions."""
        return self.decisions * self.mean


@part
class InformationLearner:
    """The diagonal of the information of all decisions."""

    model: Model
    sigma: Positive | None = 0.1  # of the change, in running deviations; None: the model's
    floor: Positive = 0.01  # entries below it are counted in the metric information/floored
    rate: Share = 0.05  # of the running mean, per batch; exact over the first 1 / rate batches
    batch_size: Count = 64
    updates: float = 1  # batches per decision

    data: ClassVar[str] = "uniform"
    owns: ClassVar[tuple[str, ...]] = ("information",)
    batches: ClassVar[int] = 1
    during_random: ClassVar[bool] = True

    def init(self, key: Array, spec: Spec) -> InformationState:
        """No information. The key is not used."""
        mean_weights.require("information_learner", self.model, spec)
        model = self.model.init(key, spec)
        size = ravel_pytree(mean_weights.of(model))[0].size
        return InformationState(jnp.zeros(size), jnp.zeros(()), jnp.zeros(()))

    def params(self, state: InformationState) -> dict[str, Any]:
        """The information."""
        return {"information": state}

    def update(
        self, state: InformationState, params: Params, batch: Batch, key: Array
    ) -> tuple[InformationState, dict[str, Array]]:
        """The information after a batch of the memory; the key is not used."""
        model = params.model

        def one(x: Array, u: Array) -> Array:
            def f(theta: Any) -> Array:
                return self.model.step(mean_weights.replaced(model, theta), x, u)

            with precision.using("float32"):
                F = fisher.jacobian(f, mean_weights.of(model))
            return fisher.diagonal(F, mean_weights.noise(self.model, model, x, self.sigma))

        now = jax.vmap(one)(batch.obs, batch.action).mean(0)
        batches = state.batches + 1
        mean = state.mean + jnp.maximum(1 / batches, self.rate) * (now - state.mean)
        decisions = state.decisions if params.decisions is None else 1.0 * params.decisions
        after = InformationState(mean, decisions, batches)
        return after, {
            "information/log_det": jnp.sum(jnp.log(after.total + self.floor)),
            "information/trace": jnp.sum(after.total),
            "information/floored": jnp.sum(after.total < self.floor).astype(jnp.float32),
        }
