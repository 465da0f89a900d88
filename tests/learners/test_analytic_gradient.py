"""The policy by the gradient of a known return: against finite differences, and on a task."""

import dataclasses
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import begun

from hybrid_rl.envs.analytic.point_mass import PointMass
from hybrid_rl.learners.analytic import AnalyticGradient
from hybrid_rl.models.exact import Exact
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.rewards.known import KnownReward
from hybrid_rl.types import Batch, Params

WORLD = PointMass()
POLICY = TanhGaussian((8,), "tanh")
RETURN = PredictedReturn(KnownReward(WORLD))
SIZES: dict[str, Any] = {"horizon": 6, "starts": 3, "learning_rate": 0.01}
LEARNER = AnalyticGradient(POLICY, Exact(WORLD), RETURN, WORLD, **SIZES)
NOTHING = Batch(*(jnp.zeros(1) for _ in Batch._fields[:-1]))


@partial(jax.jit, static_argnums=0)
def updated(learner: AnalyticGradient, state: Any, key: jax.Array) -> tuple:
    return learner.update(state, Params(model=(), policy=state.policy), NOTHING, key)


@jax.jit
def mean_return(policy: Any, key: jax.Array) -> jax.Array:
    """Minus the loss, by stepping the environment."""
    total, starting = jnp.zeros(()), jax.random.split(key)[0]
    for each in jax.random.split(starting, LEARNER.starts):
        state = WORLD.reset(each)
        for _ in range(LEARNER.horizon):
            state = WORLD.step(state, POLICY.mean(policy, state.obs))
            total += state.reward
    return total / LEARNER.starts / LEARNER.horizon


def test_the_loss_and_its_gradient_are_those_of_episodes() -> None:
    """The gradient's norm by central differences along the step of plain gradient descent."""
    state, key = begun(LEARNER, WORLD.spec), jax.random.key(1)
    plain = dataclasses.replace(LEARNER, clip=1e9)
    _, metrics = updated(plain, state, key)
    wanted = -float(mean_return(state.policy, key))
    assert float(metrics["analytic/policy_loss"]) == pytest.approx(wanted, rel=1e-5)
    flat, build = jax.flatten_util.ravel_pytree(state.policy)
    h = 1e-2
    slopes = [
        (mean_return(build(flat + e), key) - mean_return(build(flat - e), key)) / (2 * h)
        for e in h * np.eye(len(flat), dtype=np.float32)[::9]
    ]

    def gained(flat: Any) -> Any:
        return -updated(plain, state.replace(policy=build(flat)), key)[1]["analytic/policy_loss"]

    exact = jax.grad(gained)(flat)
    np.testing.assert_allclose(exact[::9], slopes, atol=2e-4)
    norm = float(jnp.linalg.norm(exact))
    assert float(metrics["analytic/gradient_norm"]) == pytest.approx(norm, rel=1e-4)
