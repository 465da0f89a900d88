"""The cart that swings a rod up, against mechanics and a NumPy roll-out."""

import jax.numpy as jnp
import numpy as np
import pytest
from worlds import follow, jitted

from hybrid_rl.envs.analytic.cart_swing_up import CartSwingUp
from hybrid_rl.envs.analytic.state import fully_observed

G = 9.81


def test_a_decision_is_two_euler_steps_with_friction() -> None:
    env, x = CartSwingUp(), np.array([2.0, 0.3, 1.0, -0.5])
    expected = x.copy()
    for _ in range(2):
        th, _, w, v = expected
        turn = (G * np.sin(th) - 6.0 * np.cos(th)) / 0.6 - 0.2 * w
        expected = expected + 0.02 * np.array([w, v, turn, -6.0 - 0.1 * v])
    np.testing.assert_allclose(follow(env, x, [[-0.6]])[1], expected, rtol=1e-12)
    assert env.spec.dt == pytest.approx(0.04)


def test_reward_is_that_of_the_thesis() -> None:
    """At 60 degrees, 1.2 m, with 6 m/s^2: 0.5 - 0.43 - 0.36."""
    after = jnp.array([np.pi / 3, 1.2, 0.0, 0.0])
    reward = CartSwingUp().reward_of(after, jnp.array([0.6]), after)
    assert float(reward) == pytest.approx(0.5 - 0.1 * 1.2**8 - 0.36, abs=1e-5)


def test_success_is_upright() -> None:
    env = CartSwingUp()
    for angle, success in ((2 * np.pi - 0.4, 1), (0.5, 0), (np.pi, 0)):
        state = fully_observed(jnp.array([angle, 0.0, 0.0, 0.0]), jnp.zeros(()))
        after = jitted(env, "step")(state, jnp.zeros(1))
        assert after.metrics["success"] == success
        assert not after.terminated


@pytest.mark.parametrize(
    ("fields", "expected"), [({}, "000"), ({"rail": 1.0}, "010"), ({"turns": 0.75}, "001")]
)
def test_the_end_of_the_rail_or_of_a_turn_ends_an_episode(fields, expected) -> None:
    """At the start, beyond 1 m, and 0.8 turns away from hanging."""
    env, ended = CartSwingUp(**fields), ""
    for th, x in ((np.pi, 0.9), (np.pi, -1.1), (-0.6 * np.pi, 0.0)):
        state = fully_observed(jnp.array([th, x, 0.0, 0.0]), jnp.zeros(()))
        ended += str(int(jitted(env, "step")(state, jnp.zeros(1)).terminated))
    assert ended == expected
