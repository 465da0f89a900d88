"""The options of a Gaussian model."""

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.types import Spec

SPEC = Spec(obs=3, act=2, dt=0.1)
X, U = jnp.array([0.3, -1.0, 2.0]), jnp.array([0.5, -0.2])


def test_the_networks_see_only_their_inputs() -> None:
    """Change and standard deviation depend on x_1 and x_2, and not on x_0."""
    model = Gaussian(hidden=(8,), state_noise=True, inputs=(1, 2))
    params = model.init(jax.random.key(0), SPEC)
    for f in (lambda x: model.change(params, x, U), lambda x: model.std(params, x)):
        slopes = np.asarray(jax.jacfwd(f)(X))
        assert (slopes[:, 0] == 0).all()
        assert (np.abs(slopes[:, 1:]).max(0) > 1e-3).all()


def test_draws_have_the_standard_deviation_of_their_state() -> None:
    """In units of the change; without `state_noise` it is constant."""
    for state_noise in (True, False):
        model = Gaussian(hidden=(8,), state_noise=state_noise)
        params = model.init(jax.random.key(0), SPEC)
        params = model.observe(params, jnp.stack([X, -X]), jnp.stack([3 * X, 2 * X]))
        noise, here = jnp.array([1.0, -2.0, 0.5]), model.std(params, X)
        drawn = model.draw(params, X[None], U[None], noise[None], jax.random.key(1))[0]
        apart = drawn - model.step(params, X, U)
        np.testing.assert_allclose(apart, params["change"].std * here * noise, rtol=1e-3)
        there = model.std(params, 2 * X)
        assert bool(jnp.any(here != there)) == state_noise
