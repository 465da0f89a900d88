"""Models in an object's frame."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.envs.sawyer_push import SawyerPush
from hybrid_rl.models.ensemble import Ensemble
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.models.turned import Turned

WORLD = SawyerPush("native", extra=("command", "turn"))
INSIDE = Ensemble(Gaussian(hidden=(8,)), members=2)
MODEL = Turned(INSIDE, WORLD)
ROTATION = np.array([[0, 1], [-1, 0]])  # by ANGLE = -90 degrees
B = 6


def around(x: np.ndarray) -> np.ndarray:
    """Observations [B, 8] of scenes turned by ANGLE, in NumPy; a square's turn stays the same."""
    return np.concatenate([*(x[:, i : i + 2] @ ROTATION.T for i in (0, 2, 4)), x[:, 6:]], 1)


@pytest.fixture(scope="module")
def data():
    """Parameters with statistics, and transitions [B, ...]."""
    draw = np.random.default_rng(0).normal(size=(2, B, 8)).astype(np.float32)
    draw[..., 6:] /= np.linalg.norm(draw[..., 6:], axis=-1, keepdims=True)
    x, after = jnp.asarray(draw[0]), jnp.asarray(draw[1])
    params = jax.jit(lambda k: MODEL.observe(MODEL.init(k, WORLD.spec), x, after))(
        jax.random.key(0)
    )
    return params, x, jnp.asarray(np.random.default_rng(1).normal(size=(B, 2)), jnp.float32), after


def test_a_turned_scene_has_the_turned_successor(data) -> None:
    """For any weights: f(R x, R u) = R f(x, u), and the loss is the same."""
    params, x, u, after = data
    step = jax.jit(jax.vmap(MODEL.step, (None, 0, 0)))
    expected = around(np.asarray(step(params, x, u)))
    there, u_there = jnp.asarray(around(np.asarray(x))), u @ ROTATION.T
    np.testing.assert_allclose(step(params, there, u_there), expected, atol=2e-4)
    after_there = jnp.asarray(around(np.asarray(after)))
    loss = jax.jit(MODEL.loss)
    np.testing.assert_allclose(
        loss(params, there, u_there, after_there, jax.random.key(3)),
        loss(params, x, u, after, jax.random.key(3)),
        rtol=1e-3,
    )


def test_the_frame_of_a_straight_block_behind_the_rod_is_the_world(data) -> None:
    """With heading 0 the model is the inner one: step, draw and loss."""
    params, x, u, after = data
    x = x.at[:, 0].set(-2.0).at[:, 1].set(0.5).at[:, 6].set(1.0).at[:, 7].set(0.0)
    np.testing.assert_allclose(
        jax.jit(jax.vmap(MODEL.step, (None, 0, 0)))(params, x, u),
        jax.jit(jax.vmap(INSIDE.step, (None, 0, 0)))(params, x, u),
        atol=1e-6,
    )
    noise, key = jax.random.normal(jax.random.key(2), x.shape), jax.random.key(3)
    np.testing.assert_allclose(
        jax.jit(MODEL.draw)(params, x, u, noise, key),
        jax.jit(INSIDE.draw)(params, x, u, noise, key),
        atol=1e-6,
    )
    given = params, x, u, after, key
    np.testing.assert_allclose(jax.jit(MODEL.loss)(*given), jax.jit(INSIDE.loss)(*given))
