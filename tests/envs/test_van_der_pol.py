"""Van der Pol's oscillator against SciPy and published numbers."""

import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from worlds import follow

from hybrid_rl.envs.analytic.van_der_pol import DT, FORCE, VanDerPol
from hybrid_rl.envs.mujoco import mjcf

ENV = VanDerPol()


def test_controlled_path_against_scipy() -> None:
    """One second of a constant control."""

    def rate(_, x):
        return [x[1], (1 - x[0] ** 2) * x[1] - x[0] - 0.3 * FORCE]

    x = follow(ENV, [1.5, -0.5], np.full((100, 1), -0.3))[-1]
    end = solve_ivp(rate, (0, 1), [1.5, -0.5], rtol=1e-11, atol=1e-12).y[:, -1]
    np.testing.assert_allclose(x, end, atol=1e-6)


def test_it_moves_on_a_limit_cycle() -> None:
    """From inside and from outside; amplitude 2.00862 and period 6.66329 are known."""
    for start in ([0.1, 0.0], [2.4, 2.4]):
        x1 = follow(ENV, start, np.zeros((4000, 1)))[2000:, 0]
        assert np.abs(x1).max() == pytest.approx(2.00862, abs=1e-4)
        t = np.flatnonzero((x1[:-1] < 0) & (x1[1:] >= 0))
        crossings = DT * (t - x1[t] / (x1[t + 1] - x1[t]))
        assert np.diff(crossings).mean() == pytest.approx(6.66329, abs=1e-4)


def test_the_scene_shows_the_limit_cycle() -> None:
    model = mjcf.load("van_der_pol.xml")
    in_the_world = model.geom_bodyid == 0
    dots = model.geom_pos[in_the_world & (model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE)]
    path = follow(ENV, [2.0, 0.0], np.zeros((2000, 1)))[1000:]
    away = np.linalg.norm(dots[:, None, :2] - path[None], axis=2).min(axis=1)
    assert len(dots) == 64
    assert away.max() < 0.51 * np.linalg.norm(np.diff(path, axis=0), axis=1).max()


def test_the_reward_weighs_state_and_control() -> None:
    state = ENV.reset(jnp.zeros(2, jnp.uint32))
    after = ENV.step(state, jnp.array([0.1]))
    assert after.reward == pytest.approx(-(np.sum(np.square(after.obs)) + 0.1 * 2.0**2), abs=1e-5)
    clipped = ENV.step(state, jnp.array([3.0]))
    np.testing.assert_array_equal(clipped.obs, ENV.step(state, jnp.array([1.0])).obs)
