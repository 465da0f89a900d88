"""The deterministic policy: its density, its network, its clones."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.stats import norm
from toys import begun

from hybrid_rl.policies.deterministic import Clones, Deterministic
from hybrid_rl.types import Spec

SPEC = Spec(obs=3, act=2, dt=0.1)
INVERSE = [("tanh", np.arctanh), ("clip", np.asarray)]
X: Any = np.random.default_rng(0).normal(size=(200, 3)).astype(np.float32)


@pytest.mark.parametrize(("squash", "inverse"), INVERSE)
def test_the_density_is_a_gaussian_before_squashing(squash: str, inverse: Any) -> None:
    """Of actions, and of samples."""
    policy = Deterministic(hidden=(5,), sigma=0.3, squash=squash)
    params = begun(policy, SPEC)
    u = np.array([0.4, -0.8])
    wanted = norm.logpdf(inverse(u), policy.unsquashed(params, X[0]), 0.3).sum()
    got = policy.log_prob(params, X[0], jnp.asarray(u))
    assert float(got) == pytest.approx(wanted, rel=1e-4)
    sample, density = policy.sample(params, X[0], jnp.array([0.1, -0.2]))
    assert float(density) == pytest.approx(float(policy.log_prob(params, X[0], sample)), rel=1e-3)
    assert (np.abs(policy.mean(params, 1e3 * X)) <= 1).all()


@pytest.mark.parametrize(("squash", "inverse"), INVERSE)
def test_beyond_saturated_actions_there_is_no_error(squash: str, inverse: Any) -> None:
    """An action of `saturation` or more is a bound of mu: of -0.95 from above, of 1 from below."""
    policy = Deterministic(hidden=(), squash=squash, saturation=0.9)
    params = begun(policy, SPEC)

    def density(mu: list[float], u: list[float]) -> float:
        last = {"Dense_0": {"kernel": jnp.zeros((3, 2)), "bias": jnp.array(mu)}}
        return float(policy.log_prob({**params, "weights": last}, X[0], jnp.array(u)))

    highest, at = 2 * norm.logpdf(0), float(inverse(0.9))
    assert density([at + 1, -at - 2], [1.0, -0.95]) == pytest.approx(highest, rel=1e-5)
    assert density([at - 1, -at + 2], [1.0, -0.95]) == pytest.approx(highest - 0.5 - 2, rel=1e-5)
    inside = float(inverse(0.5)) + 1  # not saturated: the error counts on both sides
    assert density([inside, -at], [0.5, -0.95]) == pytest.approx(highest - 0.5, rel=1e-5)


@pytest.mark.parametrize("squash", ["tanh", "clip"])
def test_the_variance_is_that_of_samples(squash: str) -> None:
    """Of 100,000, for a small sigma."""
    policy = Deterministic(hidden=(5,), sigma=0.02, squash=squash)
    params = begun(policy, SPEC)
    noise = jax.random.normal(jax.random.key(1), (100_000, 2))
    x = jnp.broadcast_to(jnp.asarray(X[0]), (100_000, 3))
    drawn = np.var(policy.sample(params, x, noise)[0], axis=0)
    np.testing.assert_allclose(policy.variance(params, X[0]), drawn, rtol=0.03)


@pytest.mark.parametrize("hidden", [(), (6,), (6, 4)])
def test_the_mean_is_the_networks(hidden: tuple[int, ...]) -> None:
    """Against NumPy."""
    policy = Deterministic(hidden=hidden, normalise=True)
    params = policy.observe(begun(policy, SPEC), 3 * X + 1)
    z = (X - (3 * X + 1).mean(0)) / (3 * X + 1).std(0)
    for i in range(len(hidden)):
        layer = params["weights"][f"Dense_{i}"]
        z = np.maximum(z @ np.asarray(layer["kernel"]) + np.asarray(layer["bias"]), 0)
    last = params["weights"][f"Dense_{len(hidden)}"]
    wanted = z @ np.asarray(last["kernel"]) + np.asarray(last["bias"])
    np.testing.assert_allclose(policy.unsquashed(params, X), wanted, atol=1e-5)


def test_clones_are_independent_policies() -> None:
    """The first one acts, and their likelihoods add up."""
    clones, alone = Clones(hidden=(5,), members=3), Deterministic(hidden=(5,))
    params, u = begun(clones, SPEC), jnp.array([0.3, -0.6])
    each = [jax.tree.map(lambda w, i=i: w[i], params) for i in range(3)]
    actions = np.stack([alone.mean(one, X) for one in each])
    np.testing.assert_allclose(clones.each(params, X), actions, atol=1e-6)
    np.testing.assert_allclose(clones.mean(params, X), actions[0], atol=1e-6)
    assert np.abs(actions[0] - actions[1]).max() > 0.01
    wanted = sum(float(alone.log_prob(one, X[0], u)) for one in each)
    assert float(clones.log_prob(params, X[0], u)) == pytest.approx(wanted, rel=1e-5)


@pytest.mark.parametrize("hidden", [(), (5,), (5, 4)])
def test_the_mean_of_clones_acts(hidden: tuple[int, ...]) -> None:
    """Of their outputs before squashing; as one network of plain arrays, too."""
    clones = Clones(hidden=hidden, members=3, acts="mean", normalise=True)
    params = clones.observe(begun(clones, SPEC), 3 * X + 1)
    each = np.arctanh(np.asarray(clones.each(params, X), np.float64))
    np.testing.assert_allclose(clones.mean(params, X), np.tanh(each.mean(0)), atol=1e-6)
    plain = clones.perceptron(params, SPEC)
    z = (X - plain.mean) / plain.scale
    for weights, biases in zip(plain.weights[:-1], plain.biases[:-1], strict=True):
        z = np.maximum(z @ weights + biases, 0)
    got = np.tanh(z @ plain.weights[-1] + plain.biases[-1])
    np.testing.assert_allclose(got, np.tanh(each.mean(0)), atol=1e-5)
