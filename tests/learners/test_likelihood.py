"""Likelihood on a world whose motion and noise are known."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.learners.likelihood import Likelihood
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.types import Batch, Params, Spec

SPEC = Spec(obs=2, act=1, dt=0.1)


def noise(x: Array) -> Array:
    """Deviation [B, 2] at x [B, 2]: from 0.02 to 0.2."""
    return 0.02 + 0.09 * (1 + x[:, :1]) * jnp.ones(2)[None]


def draw(key: Array, size: int = 200) -> Batch:
    """x' = x + (0.5 x_1, u) + noise(x) e, for x and u U(-1, 1)."""
    of_x, of_u, of_e = jax.random.split(key, 3)
    x = jax.random.uniform(of_x, (size, 2), minval=-1)
    u = jax.random.uniform(of_u, (size, 1), minval=-1)
    after = x + jnp.concatenate([0.5 * x[:, 1:], u], 1)
    after += noise(x) * jax.random.normal(of_e, (size, 2))
    no = jnp.zeros(size)
    return Batch(x, u, no, no, no, after, u)


def test_mean_and_deviation_are_learned() -> None:
    """With a deviation of the state, both are those of the world, in the world's units."""
    model = Gaussian(hidden=(64,), activation="silu", state_noise=True)
    learner = Likelihood(model)

    def one(state: object, key: Array) -> tuple:
        return learner.update(state, Params(), draw(key), key)

    first = learner.init(jax.random.key(0), SPEC)
    keys = jax.random.split(jax.random.key(1), 4000)
    state, told = jax.jit(lambda s: jax.lax.scan(one, s, keys))(first)
    known = learner.params(state)["model"]
    loss = np.asarray(told["model/loss"])
    assert loss[-100:].mean() < loss[:100].mean() - 0.5
    test = draw(jax.random.key(9), 500)
    ahead = jax.vmap(model.step, (None, 0, 0))(known, test.obs, test.action)
    wanted = test.obs + jnp.concatenate([0.5 * test.obs[:, 1:], test.action], 1)
    assert float(jnp.sqrt(jnp.mean((ahead - wanted) ** 2))) < 0.03
    std = jax.vmap(lambda x: model.std(known, x) * known["change"].std)(test.obs)
    assert float(jnp.mean(jnp.abs(std / noise(test.obs) - 1))) < 0.15


def test_bad_rates_are_named() -> None:
    """One line."""
    with pytest.raises(ValueError, match=r"likelihood\.learning_rate"):
        Likelihood(Gaussian(), learning_rate=0.0)
