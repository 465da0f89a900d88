"""Targets that choose queries by the labels so far, against NumPy."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.core.labels import Belief, Labels
from hybrid_rl.policies.deterministic import Deterministic
from hybrid_rl.targets.feature_information import FeatureInformation
from hybrid_rl.targets.likely import Likely
from hybrid_rl.targets.policy_residual import PolicyResidual
from hybrid_rl.types import Params, Spec

RNG = np.random.default_rng(5)
X, KNOWN = RNG.normal(size=(30, 4)), RNG.normal(size=(10, 4))
SCALE = np.array([1.0, 2.0, 0.5, 1.5])
POLICY = Deterministic(hidden=())
WEIGHTS = POLICY.init(jax.random.key(0), Spec(obs=4, act=2, dt=0.1))
ACTION = RNG.uniform(-1, 1, (10, 2))


def believed(evidence: Any = None, count: int = 10, capacity: int = 16) -> Params:
    """Parameters after `count` labels in a ring of `capacity`."""
    obs, action = (
        jnp.zeros((capacity, each.shape[1])).at[:count].set(each[:count])
        for each in (KNOWN, ACTION)
    )
    labels = Labels(obs, action, jnp.int32(count))
    belief = Belief(labels, jnp.asarray(KNOWN), jnp.asarray(SCALE), evidence)
    return Params(policy=WEIGHTS, belief=belief)


def at(target: Any, params: Params) -> np.ndarray:
    """exp log p at the rows of X."""
    x = jnp.asarray(X, jnp.float32)
    return np.exp(np.asarray(jax.vmap(lambda x: target.log_density(params, x))(x), float))


def test_the_gain_of_features_is_that_of_a_linear_regression() -> None:
    """log det(Z'Z + zz' + 1) - log det(Z'Z + 1) by brute force; the same point is the best."""
    target = FeatureInformation(POLICY, floor=1.0)
    each = jax.vmap(lambda x: target.evidence(believed(), x))(jnp.asarray(KNOWN, jnp.float32))
    Z, z = (np.concatenate([x, np.ones((len(x), 1))], 1) for x in (KNOWN, X))
    before = Z.T @ Z + np.eye(5)
    wanted = [np.linalg.slogdet(before + np.outer(p, p))[1] for p in z]
    wanted = np.array(wanted) - np.linalg.slogdet(before)[1]
    got = at(target, believed(each.sum(0)))
    np.testing.assert_allclose(got, wanted, rtol=1e-3)
    assert got.argmax() == wanted.argmax()


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


@dataclass(frozen=True)
class Tilted:
    """A density with a slope."""

    def log_density(self, params: Params, s: Any) -> Any:
        """The first entry."""
        return s[0]


def test_a_likely_target_is_a_product_with_a_kernel_density() -> None:
    """Of the recent states."""
    got = at(Likely(Tilted(), bandwidth=0.7, power=2.0), believed())
    away = ((X[:, None] - KNOWN[None]) / (0.7 * SCALE)) ** 2
    wanted = np.exp(X[:, 0]) * np.exp(-0.5 * away.sum(-1)).sum(1) ** 2
    np.testing.assert_allclose(got, wanted, rtol=1e-3)


def test_a_likely_target_sums_what_its_factor_needs() -> None:
    """Nothing, or the features."""
    x = jnp.asarray(X[0], jnp.float32)
    assert Likely(Tilted()).evidence(believed(), x) is None
    assert Likely(FeatureInformation(POLICY)).evidence(believed(), x).shape == (5, 5)


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        (PolicyResidual, "bandwidth"),
        (PolicyResidual, "floor"),
        (Likely, "power"),
        (FeatureInformation, "floor"),
    ],
)
def test_numbers_out_of_range_are_refused(kind: Any, name: str) -> None:
    """The error names the field."""
    part: Any = Tilted() if kind is Likely else POLICY
    with pytest.raises(ValueError, match=rf"target\.{name}=0"):
        kind(part, **{name: 0})
