"""The lander against closed forms."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from worlds import follow, jitted

from hybrid_rl.envs.analytic.lander import DT, Lander

ENV = Lander()
START = np.array([0.2, -0.4, 0.7, 0.3, -0.1, 0.5])


def test_it_follows_its_equations_and_half_thrust_hovers() -> None:
    """By Euler steps in NumPy; hovering bit for bit, also in float32."""
    u, x = np.random.default_rng(0).uniform(-1, 1, (30, 2)), START
    path = follow(ENV, START, u)
    for (right, left), after in zip(u, path[1:], strict=True):
        push = (right + left) * np.array([-np.sin(x[2]), np.cos(x[2])])
        rate = np.array([*x[3:], push[0], push[1] - 1, 2 * (right - left)])
        x = x + DT * rate
        np.testing.assert_allclose(after, x, rtol=1e-12, atol=1e-12)
    assert np.ptp(path[:, 2]) > 1
    np.testing.assert_array_equal(ENV.dynamics(*ENV.equilibrium()), np.zeros(6))


def test_the_rewards_are_the_costs_of_the_thesis() -> None:
    """At a state below the ground, with the goal of half a turn and of a whole one."""
    x, u = np.array([3.0, -0.5, -1.0, 0.3, 0.2, -0.4]), np.tanh([0.7, -0.2])
    rest = 5 * 0.25 + 10 * 0.5 + (0.09 + 0.04 + 0.16) + 0.1 * (0.49 + 0.04)
    for turns in (0.5, 1.0):
        want = 10 * (-1 + 2 * np.pi * turns) ** 2 + rest
        got = Lander(turns=turns).reward_of(jnp.zeros(6), jnp.asarray(u), jnp.asarray(x))
        assert float(got) == pytest.approx(-want, rel=1e-6)
    hover = Lander("hover").reward_of(jnp.zeros(6), jnp.asarray(u), jnp.asarray(x))
    assert float(hover) == pytest.approx(-(x @ x + 0.001 * np.sum((u - 0.5) ** 2)), rel=1e-6)


def test_a_success_holds_the_goal_for_a_second() -> None:
    """Ten decisions near the goal; one outside begins the second again, `turned` remains."""
    upside_down = jnp.array([0.0, 0.0, -jnp.pi, 0.0, 0.0, 0.0])
    step, state = jitted(ENV, "step"), jitted(ENV, "reset")(jax.random.key(0))
    assert (state.metrics["success"], state.metrics["turned"]) == (0, 0)
    for decision in range(1, 12):
        state = step(state.replace(data=upside_down), jnp.full(2, -0.5))
        assert state.metrics["success"] == (decision >= 10)
        assert state.metrics["turned"] == 1
    for off in (upside_down.at[1].set(-2.0), upside_down.at[2].set(-2.0)):
        state = step(state.replace(data=off), jnp.full(2, -0.5))
        assert (state.metrics["success"], state.metrics["turned"]) == (0, 1)
