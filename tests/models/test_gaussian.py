"""The options of a Gaussian model."""

import re
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import begun

from hybrid_rl.core import circles
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.types import Spec

SPEC = Spec(obs=3, act=2, dt=0.1)
KEY = jax.random.key(5)
X, U = jnp.array([0.3, -1.0, 2.0]), jnp.array([0.5, -0.2])


def test_the_networks_see_only_their_inputs() -> None:
    """Change and standard deviation depend on x_1 and x_2, and not on x_0."""
    model = Gaussian(hidden=(8,), state_noise=True, inputs=(1, 2))
    params = begun(model, SPEC)
    for f in (lambda x: model.change(params, x, U), lambda x: model.std(params, x)):
        slopes = np.asarray(jax.jacfwd(f)(X))
        assert (slopes[:, 0] == 0).all()
        assert (np.abs(slopes[:, 1:]).max(0) > 1e-3).all()


def test_draws_have_the_standard_deviation_of_their_state() -> None:
    """In units of the change."""
    model = Gaussian(hidden=(8,), state_noise=True)
    params = model.observe(begun(model, SPEC), jnp.stack([X, -X]), jnp.stack([3 * X, 2 * X]))
    noise, here = jnp.array([1.0, -2.0, 0.5]), model.std(params, X)
    drawn = model.draw(params, X[None], U[None], noise[None], KEY)[0] - model.step(params, X, U)
    np.testing.assert_allclose(drawn, params["change"].std * here * noise, rtol=1e-3)
    assert (here != model.std(params, 2 * X)).any()


def test_layer_norm_against_numpy() -> None:
    """W_2 relu(s (h - mean) / std + t) with h = W_1 [x, u] + b_1, over the units of the layer."""
    model = Gaussian(hidden=(8,), layer_norm=True, normalise=False)
    params = begun(model, SPEC)
    params["weights"] = jax.tree.map(lambda leaf: leaf + 0.1, params["weights"])
    w = jax.tree.map(lambda leaf: np.asarray(leaf, np.float64), params["weights"]["net"]["params"])
    hidden = np.concatenate([X, U]) @ w["Dense_0"]["kernel"] + w["Dense_0"]["bias"]
    hidden = (hidden - hidden.mean()) / np.sqrt(hidden.var() + 1e-6)
    hidden = hidden * w["LayerNorm_0"]["scale"] + w["LayerNorm_0"]["bias"]
    want = np.maximum(hidden, 0) @ w["Dense_1"]["kernel"] + w["Dense_1"]["bias"]
    np.testing.assert_allclose(model.change(params, X, U), want, rtol=1e-4, atol=1e-6)


def test_the_change_is_predicted_in_its_own_units() -> None:
    """x' = x + m + s (f + std e), m and s of the change; against NumPy."""
    model = Gaussian(hidden=(8,))
    params = begun(model, SPEC)
    params["weights"]["log_std"] = jnp.array([-1.0, -2.0, 0.5])
    rng = np.random.default_rng(0)
    x, after = rng.normal([1, 2, 3], [1, 10, 0.1], (2, 50, 3)).astype(np.float32)
    u = rng.uniform(-1, 1, (50, 2)).astype(np.float32)
    params = model.observe(params, jnp.asarray(x), jnp.asarray(after))
    m, s, std = (after - x).mean(0), (after - x).std(0), np.exp([-1.0, -2.0, 0.5])
    net = jax.tree.map(np.asarray, params["weights"]["net"]["params"])
    inputs = np.concatenate([(x - x.mean(0)) / x.std(0), u], 1)
    mean = x + m + s * (np.maximum(inputs @ net["Dense_0"]["kernel"], 0) @ net["Dense_1"]["kernel"])
    step = np.asarray(jax.vmap(model.step, (None, 0, 0))(params, x, u))
    np.testing.assert_allclose(step, mean, rtol=1e-4, atol=1e-4)
    noise = rng.normal(size=(50, 3)).astype(np.float32)
    drawn = model.draw(params, jnp.asarray(x), jnp.asarray(u), jnp.asarray(noise), None)
    np.testing.assert_allclose(drawn - step, s * std * noise, rtol=1e-2, atol=1e-3)
    density = np.log(2 * np.pi) / 2 + np.log(s * std) + ((after - mean) / (s * std)) ** 2 / 2
    loss = model.loss(params, jnp.asarray(x), jnp.asarray(u), jnp.asarray(after), KEY)
    np.testing.assert_allclose(loss, (density - np.log(s)).mean(), rtol=1e-4)


def test_it_learns_from_states_with_its_own_errors() -> None:
    """The next state stays: the loss is that of other states, and its gradient, too."""
    plain, noisy = Gaussian(hidden=(8,)), Gaussian(hidden=(8,), input_noise=0.5)
    params = begun(plain, SPEC)
    x, u, after = jax.random.normal(KEY, (20, 3)), jnp.zeros((20, 2)), jnp.ones((20, 3))
    params = plain.observe(params, x, after)
    params["weights"]["log_std"] = jnp.array([-1.0, -2.0, 0.5])
    std = params["change"].scale * jnp.exp(params["weights"]["log_std"])
    moved = x + 0.5 * std[None] * jax.random.normal(KEY, x.shape)

    def change(model, x):
        def loss(weights):
            return model.loss({**params, "weights": weights}, x, u, after, KEY)

        return jax.value_and_grad(loss)(params["weights"])

    jax.tree.map(
        lambda a, b: np.testing.assert_allclose(a, b, rtol=1e-4, atol=1e-6),
        change(noisy, x),
        change(plain, moved),
    )
    assert not np.allclose(change(noisy, x)[0], change(plain, x)[0], rtol=1e-3)


def test_the_known_physics_of_the_how_to_are_those_of_the_pendulum() -> None:
    """With networks that add nothing, in normalised units as well."""
    page = Path(__file__).parents[2] / "docs" / "howto.md"
    section = page.read_text(encoding="utf-8").split("## A model with known physics\n")[1]
    found: dict = {"__name__": "prior"}
    exec(re.findall(r"```python\n(.*?)```", section, re.S)[0], found)
    model, env, u = found["Prior"](hidden=(8,)), Pendulum(), jnp.array([[0.5]])
    starts = jax.vmap(env.reset)(jax.random.split(jax.random.key(0), 50))
    after = jax.vmap(env.step)(starts, jnp.broadcast_to(u, (50, 1))).obs
    params = begun(model, Spec(obs=3, act=1, dt=0.05), 1)
    params = model.observe(params, starts.obs, after)
    params["weights"] = jax.tree.map(jnp.zeros_like, params["weights"])
    error = jax.vmap(lambda x: model.step(params, x, u[0]))(starts.obs) - after
    assert np.abs(error).max() < 0.05  # of steps of Euler's kind: 0.05^2 s^2 times 17 rad/s^2
    assert np.abs(after - starts.obs).max() > 0.5


def test_circles_that_were_observed_are_kept() -> None:
    """A model that has learned nothing predicts sines and cosines of some angle."""
    model = Gaussian(hidden=(8,), circles=True)
    params, angles = begun(model, SPEC), jnp.linspace(-2, 2, 50)
    obs = jnp.stack((jnp.cos(angles), angles, jnp.sin(angles)), 1)
    for _ in range(circles.LEAST):
        params = model.observe(params, obs[:-1], obs[1:])
    for after in (model.step(params, X, U), *model.draw(params, X[None], U[None], X[None], KEY)):
        assert after[0] ** 2 + after[2] ** 2 == pytest.approx(1)
    plain = Gaussian(hidden=(8,)).step({k: v for k, v in params.items() if k != "circles"}, X, U)
    assert model.step(params, X, U)[1] == plain[1]
    assert abs(plain[0] ** 2 + plain[2] ** 2 - 1) > 0.1
