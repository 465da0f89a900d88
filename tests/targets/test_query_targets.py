"""Targets that choose queries by the labels so far, against NumPy."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from toys import begun

from hybrid_rl.learners.dagger import Labels, Queried
from hybrid_rl.policies.deterministic import Deterministic
from hybrid_rl.targets.policy_residual import PolicyResidual
from hybrid_rl.types import Params, Spec

RNG = np.random.default_rng(5)
X, KNOWN = RNG.normal(size=(30, 4)), RNG.normal(size=(10, 4))
SCALE = np.array([1.0, 2.0, 0.5, 1.5])
POLICY = Deterministic(hidden=())
WEIGHTS = begun(POLICY, Spec(obs=4, act=2, dt=0.1))
ACTION = RNG.uniform(-1, 1, (10, 2))


def believed(evidence: Any = None, count: int = 10, capacity: int = 16) -> Params:
    """Parameters after `count` labels in a ring of `capacity`."""
    obs, action = (
        jnp.zeros((capacity, each.shape[1])).at[:count].set(each[:count])
        for each in (KNOWN, ACTION)
    )
    labels = Labels(obs, action, jnp.int32(count))
    return Params(policy=WEIGHTS, labels=Queried(labels, jnp.asarray(SCALE), evidence))


def at(target: Any, params: Params) -> np.ndarray:
    """exp log p at the rows of X."""
    x = jnp.asarray(X, jnp.float32)
    return np.exp(np.asarray(jax.vmap(lambda x: target.log_density(params, x))(x), float))


def test_the_residual_is_that_of_kernel_regression() -> None:
    """Empty rows of the ring do not count."""
    got = at(PolicyResidual(POLICY, bandwidth=0.7), believed())
    away = ((X[:, None] - KNOWN[None]) / (0.7 * SCALE)) ** 2
    w = np.exp(-0.5 * away.sum(-1))
    u = (w @ ACTION) / w.sum(1, keepdims=True)
    layer = WEIGHTS["weights"]["Dense_0"]
    mean = np.tanh(X @ np.asarray(layer["kernel"], float))
    np.testing.assert_allclose(got, ((mean - u) ** 2).sum(1) + 1e-6, rtol=1e-3)


def test_a_residual_without_labels_is_finite() -> None:
    """And far from all labels the nearest one counts."""
    assert np.isfinite(at(PolicyResidual(POLICY), believed(count=0))).all()
    assert np.isfinite(at(PolicyResidual(POLICY, bandwidth=1e-3), believed())).all()
