"""The squashed Gaussian: its density, its samples, its variance."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.stats import norm
from toys import begun

from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.types import Spec

SPEC = Spec(obs=3, act=2, dt=1.0)
KINDS = {
    "one trunk": TanhGaussian(hidden=(16,)),
    "two networks": TanhGaussian(hidden=(16,), activation="sin", log_std_activation="relu"),
}


@pytest.mark.parametrize("policy", KINDS.values(), ids=KINDS)
def test_samples_are_squashed_normal_and_have_its_density(policy: TanhGaussian) -> None:
    """atanh of samples has mean mu and deviation sigma; log p by the change of variables."""
    params = begun(policy, SPEC)
    x = jnp.array([0.3, -0.2, 0.1])
    noise = jax.random.normal(jax.random.key(1), (20_000, SPEC.act))
    u, log_prob = jax.vmap(lambda e: policy.sample(params, x, e))(noise)
    mu, sigma = map(np.asarray, policy.gaussian(params, x))
    z = np.arctanh(np.clip(np.asarray(u, np.float64), -0.999999, 0.999999))
    np.testing.assert_allclose(z.mean(0), mu, atol=0.05)
    np.testing.assert_allclose(z.std(0), sigma, rtol=0.05)
    normal = np.exp(-0.5 * ((z[0] - mu) / sigma) ** 2) / (sigma * np.sqrt(2 * np.pi))
    wanted = np.log(normal / (1 - np.tanh(z[0]) ** 2)).sum()
    assert float(log_prob[0]) == pytest.approx(wanted, abs=1e-3)
    assert float(policy.log_prob(params, x, u[0])) == pytest.approx(wanted, abs=1e-3)
    assert (np.abs(policy.mean(params, x)) < 1).all()


def test_its_deviation_begins_as_chosen() -> None:
    policy = TanhGaussian(hidden=(16,), std=0.3)
    np.testing.assert_allclose(policy.gaussian(begun(policy, SPEC), jnp.zeros(3))[1], 0.3)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_an_action_at_its_bound_has_the_probability_to_be_there(side: float) -> None:
    """float32 does not know its z, so its density would change by orders of magnitude with mu."""
    policy, edge = TanhGaussian(hidden=()), np.arctanh(1 - 1e-6)
    trunk = {"Dense_0": {"kernel": jnp.zeros((3, 2)), "bias": jnp.array([9.0, -1.0])}}
    given = {"trunk": {"params": trunk}}, jnp.zeros(3), jnp.array([side])
    wanted = norm.logcdf((side * 9 - edge) / np.exp(-1))
    assert float(policy.log_prob(*given)) == pytest.approx(wanted, rel=1e-2, abs=1e-4)


def test_a_normalised_policy_does_not_depend_on_units() -> None:
    policy = TanhGaussian(hidden=(16,), normalise=True)
    x = jax.random.normal(jax.random.key(1), (50, SPEC.obs))
    scale, shift = jnp.array([1e-2, 1.0, 30.0]), jnp.array([5.0, 0.0, -3.0])
    first, other = begun(policy, SPEC), scale[None] * x + shift[None]
    plain, moved = (policy.observe(first, at) for at in (x, other))
    np.testing.assert_allclose(policy.mean(moved, other), policy.mean(plain, x), atol=1e-4)
    assert not np.allclose(policy.mean(first, x), policy.mean(plain, x), atol=1e-2)


@pytest.mark.parametrize(("mu", "sigma", "ratio"), [(0, 0.1, 1.02), (0, 1, 2.54), (2, 1, 0.08)])
def test_the_variance_is_that_to_first_order(mu, sigma, ratio, monkeypatch) -> None:
    """Over the true one, by Gauss-Hermite quadrature with 200 points."""
    z, weights = np.polynomial.hermite_e.hermegauss(200)
    monkeypatch.setattr(TanhGaussian, "gaussian", lambda *_: (jnp.float32(mu), jnp.float32(sigma)))
    true = np.cov(np.tanh(mu + sigma * z), aweights=weights, bias=True)
    got = float(TanhGaussian().variance({}, jnp.zeros(1)))
    assert got / true == pytest.approx(ratio, abs=0.006)
