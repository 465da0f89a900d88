"""The value of several critics."""

import jax.numpy as jnp
import numpy as np
from toys import begun

from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.types import Spec


def test_the_value_is_the_minimum() -> None:
    x, u = jnp.array([[0.3], [-2.0]]), jnp.array([[0.5], [-0.1]])
    critic = EnsembleQ(hidden=(8,), members=3)
    params = begun(critic, Spec(obs=1, act=1, dt=1.0))
    q = np.asarray(critic.all(params, x, u), np.float64)
    assert len(set(q[:, 0])) == 3
    np.testing.assert_allclose(critic.value(params, x, u), q.min(0), atol=1e-5)
