"""The value of several critics."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import begun

from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.types import Spec


@pytest.mark.parametrize(("members", "pessimism"), [(3, None), (3, 0.56), (2, 1.0)])
def test_the_value_is_the_minimum_or_counts_standard_deviations(members, pessimism) -> None:
    """Mean - p std against NumPy; of two members with p = 1 it is their minimum."""
    x, u = jnp.array([[0.3], [-2.0]]), jnp.array([[0.5], [-0.1]])
    given = {} if pessimism is None else {"pessimism": pessimism}
    critic = EnsembleQ(hidden=(8,), members=members, **given)
    params = begun(critic, Spec(obs=1, act=1, dt=1.0))
    q = np.asarray(critic.all(params, x, u), np.float64)
    assert len(set(q[:, 0])) == members
    wanted = q.mean(0) - pessimism * q.std(0) if pessimism == 0.56 else q.min(0)
    np.testing.assert_allclose(critic.value(params, x, u), wanted, atol=1e-5)


def test_critics_that_agree_have_a_finite_gradient() -> None:
    """Their standard deviation is 0, where a square root alone has no slope."""
    critic = EnsembleQ(hidden=(8,), members=3, pessimism=0.56)
    one = begun(EnsembleQ(hidden=(8,), members=1), Spec(obs=1, act=1, dt=1.0))
    params = jax.tree.map(lambda leaf: jnp.concatenate([leaf] * 3), one)
    x = jnp.array([[0.3]])
    value, slope = jax.value_and_grad(lambda u: critic.value(params, x, u)[0])(x)
    np.testing.assert_allclose(value, critic.all(params, x, x)[0, 0], atol=1e-3)
    assert np.isfinite(slope).all()
