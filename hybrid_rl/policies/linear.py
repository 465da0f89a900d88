"""u = hold - F (x - goal): a linear policy with feed-forward, whose gain a learner solves.

`hold` keeps x at the goal: the least-squares solution of goal' = f(goal, hold) in the weighted
entries of x, in one step from a known action. Source: thesis section 7.1.1; the thesis and its
author's code have no feed-forward, which leaves a constant error.
"""

from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.networks import Perceptron
from hybrid_rl.types import Spec, Step


@dataclass(frozen=True)
class Linear:
    """A linear policy; its parameters are gain, goal, hold and the inverse of the model's B."""

    clip: bool = True  # actions to [-1, 1]; false where noise is added to them

    def init(self, key: Array, spec: Spec) -> dict[str, Array]:
        """Zero gain [m, n], goal [n], hold [m] and inverse [m, n]."""
        m, n = spec.act, spec.n
        zeros = jnp.zeros((m, n))
        return {"gain": zeros, "goal": zeros[0], "hold": zeros[:, 0], "inverse": zeros}

    def aim(self, params: dict[str, Array], goal: Array, after: Array, step: Step) -> Any:
        """Parameters for the goal [n] now and `after` [n] one decision later, by the model `step`.

        hold <- clip(hold + inverse (after - f(goal, hold))), exact if f is linear in u.
        """
        missing = after - step(goal, params["hold"])
        hold = jnp.clip(params["hold"] + params["inverse"] @ missing, -1, 1)
        return {**params, "goal": goal, "hold": hold}

    def mean(self, params: dict[str, Array], x: Array) -> Array:
        """The action [m] at x [n]."""
        u = params["hold"] - params["gain"] @ (x - params["goal"])
        return jnp.clip(u, -1, 1) if self.clip else u

    def sample(self, params: dict[str, Array], x: Array, noise: Array) -> tuple[Array, Array]:
        """The same action for any noise; the log-density of a deterministic action is 0."""
        return self.mean(params, x), jnp.zeros(())

    def variance(self, params: dict[str, Array], x: Array) -> Array:
        """Zero [m]: the policy is deterministic."""
        return jnp.zeros_like(params["hold"])

    def perceptron(self, params: dict[str, Array], spec: Spec) -> Perceptron:
        """The policy as arrays: one layer, actions clipped to [-1, 1]."""
        gain, goal, hold = (np.asarray(params[key]) for key in ("gain", "goal", "hold"))
        ones = np.ones_like(goal)
        return Perceptron(goal, ones, (-gain.T,), (hold,), "relu", "clip")
