"""Learn K of a linear model by recursive least squares, one update per decision.

    K = argmin sum_i f^(N-i) |x'_i - K s_i|^2 + lam |K - K_0|^2

f < 1 forgets: where the features do not close under the dynamics, K is a local model. The prior is
not forgotten. K_0 = [I 0] predicts that nothing changes; `deviation` adds noise to it, in
continuous time: K_0 = [I 0] + s N(0, 1) dt. Source: thesis eq. (2.11) and Algorithm 7; forgetting
and prior are ours.
"""

from typing import Any, ClassVar, Literal

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.core import least_squares
from hybrid_rl.core.least_squares import Factor
from hybrid_rl.fields import Natural, NotNegative, Positive, Share, part
from hybrid_rl.protocols import Demonstrations, LinearModel
from hybrid_rl.types import Batch, Params, Spec


@struct.dataclass
class RegressionState:
    """The state of the regression, of the change x' - [I 0] s."""

    factor: Factor
    mean: Array  # [n, r] K_0 - [I 0]
    model: dict[str, Any]


@part
class LeastSquares:
    """Recursive least squares on a linear model."""

    model: LinearModel
    forgetting: Share = 1.0  # f per decision
    prior: Positive = 0.01  # lam
    mean: Literal["identity", "zero"] = "identity"  # K_0 = [I 0], or zero
    deviation: NotNegative = 0.0  # s [1/s] of K_0
    until: Natural | None = None  # decisions of the run until learning ends; None: never
    demonstrations: Demonstrations | None = None  # decisions that are learned before the first one

    data: ClassVar[str] = "latest"
    owns: ClassVar[tuple[str, ...]] = ("model",)
    every: ClassVar[int] = 1

    def init(self, key: Array, spec: Spec) -> RegressionState:
        """K_0, then what the recorded decisions add. The key is consumed."""
        of_model, of_mean = jax.random.split(key)
        model = self.model.init(of_model, spec)
        n, r = model["K"].shape
        mean = jnp.eye(n, r) * (-1.0 if self.mean == "zero" else 0.0)
        mean = mean + self.deviation * spec.dt * jax.random.normal(of_mean, (n, r))
        state = RegressionState(least_squares.begin(mean, self.prior), mean, model)
        if self.demonstrations is not None:
            rows = least_squares.rows(self.model, model, self.demonstrations.load())
            state = state.replace(factor=least_squares.fold(state.factor, *rows))
        return self._solved(state)

    def _solved(self, state: RegressionState) -> RegressionState:
        """The state with K and its spread from the factor."""
        change, spread = least_squares.solve(state.factor)
        K = jnp.eye(change.shape[0], change.shape[1]) + change
        return state.replace(model={**state.model, "K": K, "spread": spread})

    def params(self, state: RegressionState) -> dict[str, Any]:
        """The model."""
        return {"model": state.model}

    def update(
        self, state: RegressionState, params: Params, batch: Batch, key: Array
    ) -> tuple[RegressionState, dict[str, Array]]:
        """One regression step with B decisions; the loss is the squared error before it."""
        s, change = least_squares.rows(self.model, state.model, batch)
        x, predicted = s[:, : change.shape[1]], s @ state.model["K"].T
        metrics = {"model/loss": jnp.mean((x + change - predicted) ** 2)}
        factor = least_squares.add(state.factor, s, change, state.mean, self.prior, self.forgetting)
        after = self._solved(state.replace(factor=factor))
        if self.until is not None:
            learns = jnp.asarray(params.decisions) < self.until
            after = jax.tree.map(lambda new, old: jnp.where(learns, new, old), after, state)
        metrics["model/log_det_information"] = least_squares.log_det(after.factor.U)
        return after, metrics
