"""Van der Pol's oscillator against SciPy and published numbers."""

import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from worlds import follow

from hybrid_rl.envs.analytic.van_der_pol import DT, FORCE, VanDerPol

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


def test_the_reward_weighs_state_and_control() -> None:
    state = ENV.reset(jnp.zeros(2, jnp.uint32))
    after = ENV.step(state, jnp.array([0.1]))
    assert after.reward == pytest.approx(-(np.sum(np.square(after.obs)) + 0.1 * 2.0**2), abs=1e-5)
    clipped = ENV.step(state, jnp.array([3.0]))
    np.testing.assert_array_equal(clipped.obs, ENV.step(state, jnp.array([1.0])).obs)
