"""Noise through knots against interpolation by NumPy, and against B-splines."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from hybrid_rl.core.sampling import Candidates
from hybrid_rl.proposals.knots import KnotsProposal
from hybrid_rl.proposals.mixture import MixtureProposal
from hybrid_rl.proposals.noise import NoiseProposal
from hybrid_rl.types import Params, Spec

M = 2
NOISE = np.random.default_rng(0).normal(size=(20, M)).astype(np.float32)


@pytest.mark.parametrize(("knots", "steps"), [(2, 20), (3, 7), (5, 20), (9, 20), (20, 20)])
@pytest.mark.parametrize("order", ["linear", "cubic"])
def test_noise_is_interpolated_between_its_knots(order: str, knots: int, steps: int) -> None:
    """Piecewise linear, or the natural cubic spline, with knots from the first to the last step."""
    got = KnotsProposal(knots, order).shaped(jnp.asarray(NOISE[:steps]))
    t, now = np.linspace(0, steps - 1, knots), np.arange(steps)
    want = np.stack([np.interp(now, t, entry) for entry in NOISE[:knots].T], 1)
    if order == "cubic" and knots > 2:
        want = make_interp_spline(t, NOISE[:knots], bc_type="natural")(now)
    np.testing.assert_allclose(got, want, atol=2e-6)


def test_one_knot_holds_and_many_are_white() -> None:
    """One knot is constant over the horizon; with a knot per step nothing is interpolated."""
    noise = jnp.asarray(NOISE)
    np.testing.assert_array_equal(KnotsProposal(1).shaped(noise), np.tile(NOISE[:1], (20, 1)))
    np.testing.assert_allclose(KnotsProposal(50).shaped(noise), NOISE, atol=1e-6)


def test_a_mixture_shapes_the_noise_of_each() -> None:
    """One half of the candidates is smooth, the other white."""
    knots, white = KnotsProposal(2, std=0.1), NoiseProposal(std=0.1)
    both, plan = Candidates(MixtureProposal(knots, white), 4), jnp.full(NOISE.shape, 0.2)
    begun, key = both.begin(Spec(obs=1, act=M, dt=0.1)), jax.random.key(0)
    u = both.imagine(Params(), lambda x, u: x, begun, jnp.zeros(1), plan, key).path.u
    noise = jax.random.normal(key, u.shape)
    want = np.stack([*map(knots.shaped, noise[:2]), *noise[2:]])
    np.testing.assert_allclose(u, np.clip(0.2 + 0.1 * want, -1, 1), rtol=1e-5)
