"""The point mass in closed form, and its drag by many small steps."""

import jax.numpy as jnp
import numpy as np
from worlds import follow

from hybrid_rl.envs.analytic.point_mass import ACCELERATION, DT, PointMass


def test_without_drag_its_path_is_a_parabola() -> None:
    x = follow(PointMass(), [0.1, 0.2, 0.3, 0.0], np.tile([1.0, -0.5], (10, 1)))[-1]
    t = 10 * DT
    half = 0.5 * ACCELERATION * t**2
    np.testing.assert_allclose(x[:2], [0.1 + 0.3 * t + half, 0.2 - 0.5 * half], atol=1e-12)


def test_drag_follows_its_differential_equation() -> None:
    """Many small Euler steps."""
    x, u = np.array([0.1, 0.2, 1.0, -0.5]), np.array([0.3, -0.9])
    after = PointMass(1.5, 0.7).dynamics(jnp.asarray(x), jnp.asarray(u))
    for _ in range(10_000):
        middle = x[2:] + 0.5e-5 * (1.5 * u - 0.7 * x[2:])
        x = x + 1e-5 * np.concatenate([middle, 1.5 * u - 0.7 * middle])
    np.testing.assert_allclose(after, x, atol=1e-6)
