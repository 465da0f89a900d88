"""The ball in sand against closed forms and SciPy."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from worlds import flown, jitted

from hybrid_rl.envs.analytic.sprk_sand import DT, Ball, SprkSand

KEY = jax.random.key(3)
EXACT = SprkSand(learn=30, sensor_noise=0.0)
NOISY = SprkSand(learn=30)


def test_path_against_an_accurate_integration() -> None:
    """Two seconds of a constant command with slip and varying sand, by SciPy."""
    a = np.array([-0.5, 0.7])

    def rate(_, s):
        p, v, c = s[:2], s[2:4], s[4:]
        speed = np.hypot(*v)
        k = 4.0 * (1 + 0.2 * np.sin(2 * np.pi * p[0]) * np.sin(2 * np.pi * p[1]))
        rotation = np.array([[np.cos(0.15), -np.sin(0.15)], [np.sin(0.15), np.cos(0.15)]])
        dry = 0.6 * np.tanh(speed / 0.02) / speed if speed else 0.0
        return np.concatenate([v, k * rotation @ c - (1.5 + 3.0 * speed + dry) * v, (a - c) / 0.1])

    path = flown(EXACT, KEY, np.tile(a, (60, 1)))
    start = np.concatenate([path.data.p[0], np.zeros(4)])
    end = solve_ivp(rate, (0, 60 * DT), start, rtol=1e-9, atol=1e-11).y[:, -1]
    np.testing.assert_allclose(np.concatenate([leaf[-1] for leaf in path.data]), end, atol=1e-4)
    np.testing.assert_array_equal(path.obs[:, :2], path.data.p)
    np.testing.assert_array_equal(path.obs[:, 2:4], path.data.v)


def test_the_reference_rests_and_then_follows_the_curve() -> None:
    """Its velocity is the derivative of its position, by central differences of fourth order."""
    now, later = np.split(flown(EXACT, KEY, np.zeros((300, 2))).obs[:, 4:], 2, axis=1)
    np.testing.assert_array_equal(later[:-1], now[1:])
    np.testing.assert_allclose(now[:30], [[1.62, 0.85, 0, 0]] * 30, atol=1e-6)
    p, v = now[30:, :2], now[30:, 2:]
    t = DT * np.arange(271)
    curve = np.column_stack([0.5 * np.cos(t) + 1.12, 0.3 * np.sin(2 * t) + 0.85])
    np.testing.assert_allclose(p, curve, atol=1e-5)
    slope = (8 * (p[3:-1] - p[1:-3]) - (p[4:] - p[:-4])) / (12 * DT)
    np.testing.assert_allclose(v[2:-2], slope, atol=1e-4)
    np.testing.assert_allclose(v[0], [0, 0.6], atol=1e-6)


def test_equilibrium_is_a_state_at_rest_on_the_reference() -> None:
    """The ball stays there until the reference moves."""
    env = SprkSand(sensor_noise=0.0, start=0.0)
    obs, action = env.equilibrium()
    path = flown(env, KEY, np.tile(action, (5, 1)))
    np.testing.assert_allclose(path.obs, np.tile(obs, (6, 1)), atol=1e-6)
    np.testing.assert_allclose(path.metrics["tracking_error"], 0, atol=1e-6)


def test_noise_is_that_of_a_camera() -> None:
    """White on the position; the velocity is the difference. The physics is that without noise."""
    actions = np.random.default_rng(0).uniform(-1, 1, (1000, 2))
    exact, path = flown(EXACT, KEY, actions), flown(NOISY, KEY, actions)
    np.testing.assert_allclose(path.data.p, exact.data.p, atol=1e-6)
    np.testing.assert_allclose(path.reward, exact.reward, atol=1e-5)
    noise = path.obs[:, :2] - path.data.p
    np.testing.assert_allclose(noise.std(axis=0), 0.003, rtol=0.1)
    assert np.abs(np.corrcoef(noise[1:].T, noise[:-1].T) - np.eye(4)).max() < 0.15
    np.testing.assert_allclose(path.obs[1:, 2:4], np.diff(path.obs[:, :2], axis=0) / DT, atol=1e-4)
    np.testing.assert_array_equal(path.obs[:, 4:], exact.obs[:, 4:])
    np.testing.assert_array_equal(path.obs[0, 2:4], 0)


def test_reward_and_tracking_error() -> None:
    """The thesis' weights, of the state after the decision."""
    still = Ball(jnp.array([1.0, 1.0]), jnp.zeros(2), jnp.zeros(2))
    after = jitted(EXACT, "step")(EXACT.reset(KEY).replace(data=still), jnp.array([0.0, 2.0]))
    e = np.concatenate([after.data.p - np.array([1.62, 0.85]), after.data.v])
    assert after.metrics["tracking_error"] == pytest.approx(np.hypot(e[0], e[1]), rel=1e-5)
    assert after.reward == pytest.approx(-(e**2) @ [60, 60, 5, 5] - 0.1, rel=1e-5)
