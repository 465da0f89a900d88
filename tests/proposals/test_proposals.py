"""Proposals: noise, policy and mixture."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.stats import multivariate_normal
from toys import begun

from hybrid_rl.core import sampling
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.proposals.mixture import MixtureProposal
from hybrid_rl.proposals.noise import NoiseProposal
from hybrid_rl.proposals.policy import PolicyProposal
from hybrid_rl.protocols import Proposal
from hybrid_rl.types import Params, Spec

SPEC = Spec(obs=2, act=2, dt=0.1)
K, T = 8, 5
POLICY = TanhGaussian(hidden=(8,))
NOISE, BY_POLICY = NoiseProposal(std=0.3), PolicyProposal(POLICY)


def imagined(proposal: Proposal, samples: int = K) -> sampling.Samples:
    """Candidates in a model x' = x + u."""
    params = Params(policy=begun(POLICY, SPEC))
    both = sampling.Candidates(proposal, samples)
    plan, key = jnp.full((T, SPEC.act), 0.1), jax.random.key(1)
    start = jnp.ones(SPEC.obs)
    return both.imagine(params, lambda x, u: x + u, both.begin(SPEC), start, plan, key)


@pytest.mark.parametrize(("share", "count"), [(0.0, 0), (0.25, 2), (0.5, 4), (1.0, 8)])
def test_a_mixture_has_candidates_of_both_proposals(share, count) -> None:
    """The first `share` of the paths equal those of the first proposal, the others the second's."""
    mixed = imagined(MixtureProposal(BY_POLICY, NOISE, share))
    one, two = imagined(BY_POLICY), imagined(NOISE)
    for got, first, second in zip(
        jax.tree.leaves(mixed), jax.tree.leaves(one), jax.tree.leaves(two), strict=True
    ):
        np.testing.assert_allclose(got[:count], first[:count], rtol=1e-6)
        np.testing.assert_array_equal(got[count:], second[count:])


def test_strengths_divide_the_candidates() -> None:
    """At the first decision, where all see the same state: quiet ones act by the scaled mean."""
    proposal = PolicyProposal(POLICY, (1.0, 0.5), quiet=0.5)
    first = imagined(proposal).path.u[:, 0]
    loud = imagined(PolicyProposal(POLICY)).path.u[:, 0]
    mean = POLICY.mean(begun(POLICY, SPEC), jnp.ones(SPEC.obs))
    np.testing.assert_allclose(first[:2], jnp.stack([mean, mean]), rtol=1e-5)
    np.testing.assert_allclose(first[2:4], loud[2:4], rtol=1e-5)
    np.testing.assert_allclose(first[4:6], 0.5 * jnp.stack([mean, mean]), rtol=1e-5)
    np.testing.assert_allclose(first[6:], 0.5 * loud[6:], rtol=1e-5)
    assert np.unique(np.asarray(first)).size == 12
    first = imagined(PolicyProposal(POLICY, quiet=0.5)).path.u[:, 0]
    np.testing.assert_allclose(first, [*[mean] * 4, *loud[4:]], rtol=1e-5)


@pytest.mark.parametrize("correlation", [0.0, 0.8])
def test_noise_is_stationary_from_the_first_decision(correlation) -> None:
    """It has the same standard deviation and the same correlations at each decision.

    What it adds to the plan is clipped.
    """
    samples = 20_000
    paths = imagined(NoiseProposal(std=0.2, correlation=correlation), samples)
    e = np.asarray(paths.path.u)[:, :, 0] - 0.1
    np.testing.assert_allclose(e.std(0), 0.2, rtol=0.03)
    wanted = correlation ** np.abs(np.subtract.outer(np.arange(T), np.arange(T)))
    np.testing.assert_allclose(np.corrcoef(e.T), wanted, atol=0.03)
    wide = imagined(NoiseProposal(std=2.0, correlation=correlation)).path.u
    assert np.abs(wide).max() == 1


@pytest.mark.parametrize("correlation", [0.0, 0.8])
def test_log_density_is_that_of_the_process(correlation) -> None:
    """Over a whole path it sums to the density of a Gaussian whose covariance is Toeplitz."""
    paths = imagined(NoiseProposal(std=0.2, correlation=correlation))
    e = np.asarray(paths.path.u, float) - 0.1
    covariance = 0.2**2 * correlation ** np.abs(np.subtract.outer(np.arange(T), np.arange(T)))
    density = multivariate_normal(cov=covariance).logpdf
    wanted = density(e[:, :, 0]) + density(e[:, :, 1])
    np.testing.assert_allclose(paths.log_prob.sum(1), wanted, rtol=1e-3, atol=1e-3)
