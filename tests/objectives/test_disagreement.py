"""The information of an ensemble's disagreement against NumPy."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import begun

from hybrid_rl.models.ensemble import Ensemble
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.objectives.disagreement import Disagreement
from hybrid_rl.types import Params, Path, Spec

SPEC = Spec(obs=2, act=1, dt=0.1)


def test_information_is_that_of_the_members_predictions() -> None:
    """Linear members, so that NumPy predicts their changes."""
    model = Ensemble(Gaussian(hidden=()), 3)
    params = begun(model, SPEC)
    rng = np.random.default_rng(0)
    obs = rng.normal(size=(50, 2)) * [1.0, 5.0]
    change = rng.normal(size=(50, 2)) * [0.1, 2.0]
    params = model.observe(params, jnp.asarray(obs), jnp.asarray(obs + change))
    x, u = rng.normal(size=(5, 2)), rng.uniform(-1, 1, (4, 1))
    path = Path(jnp.asarray(x, jnp.float32), jnp.asarray(u, jnp.float32))
    layer = params["weights"]["net"]["params"]["Dense_0"]
    inputs = np.concatenate([(x[:4] - obs.mean(0)) / obs.std(0), u], 1)
    each = np.einsum("ti,kio->kto", inputs, layer["kernel"]) + np.asarray(layer["bias"])[:, None]
    rewards = 0.5 * np.log(1 + each.var(0) / 0.2**2).sum(-1)
    objective = Disagreement(model, noise=0.2)
    seen = Params(model=params)
    np.testing.assert_allclose(objective.rewards(seen, path), rewards, rtol=1e-4)
    to_go = np.append(np.cumsum(rewards[::-1])[::-1], 0)
    np.testing.assert_allclose(objective.reward_to_go(seen, path), to_go, rtol=1e-4)
    value, _ = objective.prepare(seen, (), path.x[0], path.u[0], jax.random.key(0))
    assert float(value(path)) == pytest.approx(to_go[0], rel=1e-4)
