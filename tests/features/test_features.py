"""Features: products of coordinates, and networks that contain the state."""

import jax.numpy as jnp
import numpy as np
from hydra.utils import instantiate
from toys import begun

from hybrid_rl.features.monomials import Monomials
from hybrid_rl.features.network import Network
from hybrid_rl.settings import build as config
from hybrid_rl.types import Spec

SPEC = Spec(obs=4, act=1, dt=0.1)
OBS = np.array([0.5, -2.0, 3.0, 7.0])


def test_monomials_are_products_of_scaled_coordinates() -> None:
    """Coordinates, a constant, then each term."""
    features = Monomials((3, 1), (0.5, 1.0), (1.0, 0.0), True, ((0, 0), (1, 0, 1)))
    params = begun(features, SPEC)
    y = np.array([(7.0 - 1) * 0.5, -2.0])
    expected = [*y, 1.0, y[0] ** 2, y[1] * y[0] * y[1]]
    np.testing.assert_allclose(features(params, jnp.asarray(OBS)), expected, rtol=1e-6)


def test_a_network_contains_the_state() -> None:
    features = Network((0, 2), 5, (8,))
    z = features(begun(features, SPEC), jnp.asarray(OBS, jnp.float32))
    np.testing.assert_allclose(z[:2], OBS[[0, 2]])
    assert z.shape == (7,)


def lifted(obs, *words):
    """z [n] of the model that these words compose."""
    model = instantiate(config.load([*words]).learners.model.model, _convert_="all")
    return model.lift(begun(model, Spec(len(obs), 4, 0.1)), jnp.asarray(obs))


def test_the_lift_of_the_quadcopter_has_the_printed_terms() -> None:
    """Gravity, w, v and nine products, with the second index of v3 w2 corrected."""
    rng = np.random.default_rng(0)
    R, v, w = np.linalg.qr(rng.normal(size=(3, 3)))[0], rng.normal(size=3), rng.normal(size=3)
    products = [(v[2], w[1]), (v[1], w[2]), (v[2], w[0]), (v[0], w[2]), (v[1], w[0])]
    products += [(v[0], w[1]), (w[1], w[2]), (w[0], w[2]), (w[0], w[1])]
    expected = [*R.T @ [0, 0, -9.81], *w, *v, *(a * b for a, b in products)]
    obs = np.concatenate([np.zeros(3), R.ravel(), v, w])
    got = lifted(obs, "task=quadcopter_se3", "algo=koopman_active", "features=quadcopter")
    np.testing.assert_allclose(got, expected, rtol=1e-5)


def test_the_lift_of_sawyer_has_the_printed_functions() -> None:
    """51: angles and rates, 1, and (q_i q_i+1)^k, (q'_i q'_i+1)^k, k = 1, 2, 3; rates times 0.2."""
    obs = np.random.default_rng(0).uniform(-2, 2, 42)
    q, rate = obs[:7], 0.2 * obs[7:14]
    pairs = [y[:-1] * y[1:] for y in (q, rate)]
    expected = np.concatenate([q, rate, [1.0], *(pair**k for pair in pairs for k in (1, 2, 3))])
    got = lifted(obs, "task=sawyer_torque", "algo=koopman_track", "features=sawyer")
    assert got.shape == (51,)
    np.testing.assert_allclose(got, expected, rtol=1e-5)
