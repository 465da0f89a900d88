"""pybullet's reward for walking robots, shared by ant, half-cheetah, hopper and walker.

    r = alive + dx/dt - 2 mean_i |a_i w_i| - 0.1 mean_i a_i^2 - 0.1 #{i : |theta_i| > 0.99}

a: action in [-1, 1]; w: 0.1 x joint velocity; theta: joint angle scaled so that its limits are
-1 and 1; alive: +1 or -1 by the robot's own rule; x: position of the root (in pybullet the mean
over all parts).

Source: pybullet_envs, WalkerBaseBulletEnv (the thesis' reward, Appendix B).
"""

import jax.numpy as jnp
from jax import Array


def pybullet_reward(
    alive: Array,  # [] bool
    speed: Array,  # [] dx/dt [m/s]
    action: Array,  # [m] in [-1, 1]
    angle: Array,  # [m] of the actuated joints [rad]
    velocity: Array,  # [m] [rad/s]
    limits: Array,  # [m, 2] [rad]
) -> Array:
    """Reward [] of one decision."""
    middle, half = limits.mean(1), (limits[:, 1] - limits[:, 0]) / 2
    at_limit = (jnp.abs((angle - middle) / half) > 0.99).sum()
    electricity = 2.0 * jnp.abs(action * 0.1 * velocity).mean() + 0.1 * (action**2).mean()
    return jnp.where(alive, 1.0, -1.0) + speed - electricity - 0.1 * at_limit
