"""The information of demonstrations, and clones that disagree, against closed forms in NumPy."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import begun

from hybrid_rl.core.domain import Box
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.learners.dagger import Queried, empty
from hybrid_rl.policies.deterministic import Clones, Deterministic
from hybrid_rl.targets.policy_disagreement import PolicyDisagreement
from hybrid_rl.targets.policy_information import PolicyInformation
from hybrid_rl.types import Params, Spec

SPEC = Spec(obs=4, act=2, dt=0.1)
X: Any = np.random.default_rng(3).normal(size=(30, 4))


def made(hidden: tuple[int, ...], criterion: str, sigma: float = 0.5) -> tuple:
    """A target and random parameters, biases included."""
    policy = Deterministic(hidden=hidden, activation="sin", sigma=sigma)
    params = begun(policy, SPEC)
    leaves, tree = jax.tree.flatten(params)
    keys = jax.random.split(jax.random.key(1), len(leaves))
    moved = [x + 0.3 * jax.random.normal(k, x.shape) for x, k in zip(leaves, keys, strict=True)]
    params = Params(policy=jax.tree.unflatten(tree, moved))
    return PolicyInformation(policy, criterion=criterion, sigma=sigma), params


def at(target: PolicyInformation, params: Params, x: np.ndarray) -> np.ndarray:
    """exp log p at the rows of x."""
    log_p = jax.vmap(lambda x: target.log_density(params, x))(jnp.asarray(x, jnp.float32))
    return np.exp(np.asarray(log_p, float))


def known(evidence: np.ndarray) -> Queried:
    """Labels of this information."""
    return Queried(empty(1, 4, 2), jnp.ones(4), jnp.asarray(evidence, jnp.float32))


def test_the_trace_of_one_sine_layer_is_its_closed_form() -> None:
    """sum_i [sum_j sin^2 h_j + 1 + (|x|^2 + 1) sum_j W2_ij^2 cos^2 h_j] / sigma^2."""
    target, params = made((7,), "trace")
    first, last = (params.policy["weights"][name] for name in ("Dense_0", "Dense_1"))
    W1, b1, W2 = (np.asarray(a, float) for a in (first["kernel"], first["bias"], last["kernel"]))
    h = X @ W1 + b1
    inner = ((X**2).sum(1) + 1) * (np.cos(h) ** 2 @ (W2**2).sum(1))
    wanted = (2 * ((np.sin(h) ** 2).sum(1) + 1) + inner) / 0.25
    np.testing.assert_allclose(at(target, params, X), wanted, rtol=1e-4)


def test_the_inverse_of_a_linear_policy_is_that_of_its_regressors() -> None:
    """1 / tr (I + floor)^-1, I_j = z_j^2 / sigma^2 for z = (x, 1), once for each action."""
    target, params = made((), "inverse")
    z = np.concatenate([X, np.ones((30, 1))], 1)
    wanted = 1 / (2 / (z**2 / 0.25 + 0.01)).sum(1)
    np.testing.assert_allclose(at(target, params, X), wanted, rtol=1e-4)


def test_the_gain_picks_the_point_that_brute_force_picks() -> None:
    """argmax of log det of the information with and without the point, its diagonal, in NumPy."""
    target, params = made((), "gain", sigma=1.0)
    z = np.concatenate([X, np.ones((30, 1))], 1)
    before = z[:10].T @ z[:10]
    order = [  # of the leaves: bias [2], kernel [4, 2]
        *[before[4, 4]] * 2,
        *np.repeat(np.diag(before)[:4], 2),
    ]
    params = params._replace(labels=known(np.array(order)))
    prior = 0.01 * np.eye(5)

    def log_det(A: np.ndarray) -> float:
        return np.linalg.slogdet(np.diag(np.diag(A + prior)))[1]

    wanted = np.array([log_det(before + np.outer(p, p)) - log_det(before) for p in z])
    got = at(target, params, X)
    np.testing.assert_allclose(got, 2 * wanted, rtol=1e-4)
    assert got.argmax() == wanted.argmax()


def test_the_information_does_not_vanish_where_the_action_is_saturated() -> None:
    """It is that of the mean before tanh."""
    target, params = made((), "trace")
    far = 100 * X[:1]
    assert np.allclose(np.abs(target.policy.mean(params.policy, jnp.asarray(far[0]))), 1, atol=1e-5)
    np.testing.assert_allclose(at(target, params, far), 8 * ((far**2).sum() + 1), rtol=1e-4)


def test_other_coordinates_have_their_equilibrium_values() -> None:
    """The trace of a linear policy: |x|^2 is 3 of the rotation matrix and |s|^2."""
    policy, s = Deterministic(hidden=()), jnp.array([0.7, -0.2])
    world: Any = QuadcopterSE3()
    target = PolicyInformation(policy, world, Box((12, 17), (-1, -1), (1, 1)), "trace")
    params = Params(policy=begun(policy, Spec(obs=18, act=4, dt=0.1)))
    wanted = np.log(4 * (3 + 0.49 + 0.04 + 1))
    assert float(target.log_density(params, s)) == pytest.approx(wanted, rel=1e-5)


def test_the_disagreement_is_the_variance_of_the_clones() -> None:
    """In NumPy, of linear clones that are clipped."""
    policy = Clones(hidden=(), squash="clip", members=4)
    params = begun(policy, SPEC)
    W = np.asarray(params["weights"]["Dense_0"]["kernel"], float)
    wanted = np.clip(X @ W, -1, 1).var(0).sum(1)
    target = PolicyDisagreement(policy)
    log_p = jax.vmap(lambda x: target.log_density(Params(policy=params), x))(jnp.asarray(X))
    np.testing.assert_allclose(np.exp(log_p), wanted, rtol=1e-3, atol=1e-7)
