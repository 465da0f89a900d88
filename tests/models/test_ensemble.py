"""Ensembles beside their members one by one."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.models.ensemble import Ensemble
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.types import Spec

SPEC = Spec(obs=3, act=2, dt=0.1)
ONE = Gaussian(hidden=(8,))
MODEL = Ensemble(ONE, members=4)
X, U, NOISE = jnp.array([0.3, -1.0, 2.0]), jnp.array([0.5, -0.2]), jnp.array([1.0, 0.0, -2.0])


def member(params: dict, i: int) -> dict:
    """Parameters of member i alone."""
    return {**params, "weights": jax.tree.map(lambda w: w[i], params["weights"])}


@pytest.fixture
def params():
    return MODEL.init(jax.random.key(0), SPEC)


def test_members_differ_and_are_averaged(params) -> None:
    """step is the mean of what the members say, and they do not say the same."""
    each = np.stack([ONE.step(member(params, i), X, U) for i in range(4)])
    assert each.std(0).min() > 1e-3
    np.testing.assert_allclose(MODEL.each(params, X, U), each, rtol=1e-6)
    np.testing.assert_allclose(MODEL.step(params, X, U), each.mean(0), rtol=1e-5)
    losses = [ONE.loss(member(params, i), X, U, 2 * X) for i in range(4)]
    np.testing.assert_allclose(MODEL.loss(params, X, U, 2 * X), np.mean(losses), rtol=1e-5)


@pytest.mark.parametrize(("place", "i"), [(0.0, 0), (0.24, 0), (0.26, 1), (0.99, 3)])
def test_draw_is_one_member(params, place, i) -> None:
    """With its own noise."""
    got = MODEL.draw(params, X, U, NOISE, jnp.float32(place))
    wanted = ONE.draw(member(params, i), X, U, NOISE, jnp.float32(0))
    np.testing.assert_allclose(got, wanted, rtol=1e-6)
    std = np.exp(np.asarray(params["weights"]["log_std"][i]))
    np.testing.assert_allclose(
        wanted - ONE.step(member(params, i), X, U), std * NOISE, rtol=1e-4, atol=1e-5
    )


def test_bad_fields() -> None:
    """One line that names the field."""
    with pytest.raises(ValueError, match=r"model\.members=0"):
        Ensemble(ONE, 0)
