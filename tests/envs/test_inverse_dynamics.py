"""Torques that give accelerations, against MuJoCo's mj_inverse."""

import jax
import mujoco
import numpy as np
import pytest

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import torques
from hybrid_rl.envs.sawyer_torque import asset


@pytest.mark.parametrize(("damping", "payload"), [("none", 0.0), ("maker", 1.5)])
def test_inverse_dynamics_agree_with_mujoco(damping, payload):
    name, rng = asset(damping, payload), np.random.default_rng(0)
    model = mjcf.load(name)
    data, inverse = mujoco.MjData(model), jax.jit(lambda *x: torques(name, *x))
    for _ in range(5):
        x = [scale * rng.normal(size=7).astype(np.float32) for scale in (0.7, 2, 10)]
        data.qpos[:], data.qvel[:], data.qacc[:] = x
        mujoco.mj_inverse(model, data)
        assert not data.nefc  # within the joints' ranges
        np.testing.assert_allclose(inverse(*x), data.qfrc_inverse, atol=1e-4)
