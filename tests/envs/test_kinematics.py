"""Kinematics of arms against MuJoCo C and their makers' tables."""

from math import pi

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import placed

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import (
    Chain,
    damped_inverse,
    inverse,
    quat_multiply,
    rotate,
    rotate_towards,
    torques,
)
from hybrid_rl.envs.panda_stack import READY
from hybrid_rl.envs.sawyer_push import HOME
from hybrid_rl.envs.sawyer_torque import asset

SAWYER, PANDA = "sawyer_push.xml", "panda_stack.xml"
POSES = [  # asset, site, joints [rad], position of the site [m]; from the makers' tables
    (SAWYER, "hand", (0, -1.18, 0, 2.18, 0, 0.57, 3.3161), (0.4496, 0.1603, 0.2158)),
    (SAWYER, "hand", HOME, (0.5595, 0.0307, -0.0530)),
    (SAWYER, "hand", (-0.2, -0.6, 0, 1.9, 0, 0.3, 1.571), (0.5358, 0.0550, 0.0230)),
    (SAWYER, "hand", (0,) * 7, (1.0155, 0.1603, 0.3170)),
    (PANDA, "tool", READY, (0.30689, 0, 0.48688)),
    (PANDA, "tool", (0, 0, 0, -pi / 2, 0, pi / 2, -0.7853), (0.5545, 0, 0.5211)),
    (PANDA, "tool", (0, 0.3, 0, -pi / 2, 0, 2, -0.7853), (0.6778, 0, 0.3785)),
    (PANDA, "tool", (0, pi / 16, 0, -5 * pi / 6, 0, pi - 0.2, pi / 4), (0.4581, 0, 0.0922)),
]


def _pose(asset, site, qpos):
    return jax.jit(Chain(asset, site).pose)(jnp.asarray(qpos, jnp.float32))


def test_chain_of_slides_and_shifted_hinges(tmp_path):
    file = tmp_path / "chain.xml"
    inner = """<body pos="0.3 0 0" quat="1 2 0 0"><joint axis="0 1 0" pos="0.1 0.2 0"/>
      <joint type="slide" axis="0 0.6 0.8" ref="0.5"/><geom size="0.1"/>
      <site name="end" pos="0 0 1" quat="1 0 1 0"/></body>"""
    file.write_text(
        "<mujoco><option><flag autoreset='disable'/></option><worldbody><body>"
        f"<joint type='slide'/><geom size='0.1'/>{inner}</body></worldbody></mujoco>"
    )
    model, data = placed(str(file), (0.4, 0.7, -0.2))
    position, rotation, jacobian = _pose(str(file), "end", data.qpos)
    expected = np.zeros((2, 3, model.nv))
    mujoco.mj_jacSite(model, data, *expected, 0)
    np.testing.assert_allclose(position, data.site("end").xpos, atol=1e-6)
    np.testing.assert_allclose(jacobian, expected.reshape(6, -1), atol=1e-6)
    constant, quat = Chain(str(file), "end").constant_pose((0.4, 0.7, -0.2))
    np.testing.assert_allclose(constant, position, atol=1e-6)
    np.testing.assert_allclose(np.abs(quat @ rotation), 1.0, atol=1e-6)


@pytest.mark.parametrize(("asset", "site", "joints", "expected"), POSES)
def test_poses_are_those_of_the_makers_and_of_mujoco(asset, site, joints, expected):
    """Position, rotation and Jacobian at this pose and at one nearby."""
    for shift in (0.0, 0.1):
        model, data = placed(asset, np.add(joints, shift))
        position, rotation, jacobian = _pose(asset, site, data.qpos)
        jac = np.zeros((2, 3, model.nv))
        mujoco.mj_jacSite(model, data, *jac, model.site(site).id)
        matrix = jax.vmap(rotate, (None, 0), 1)(rotation, jnp.eye(3))
        if shift == 0:
            np.testing.assert_allclose(data.site(site).xpos, expected, atol=6e-5)
        np.testing.assert_allclose(position, data.site(site).xpos, atol=2e-6)
        np.testing.assert_allclose(matrix, data.site(site).xmat.reshape(3, 3), atol=2e-6)
        np.testing.assert_allclose(jacobian, jac.reshape(6, -1)[:, :7], atol=2e-6)


@pytest.mark.parametrize(("asset", "site", "joints"), [POSES[1][:3], POSES[4][:3]])
def test_damped_least_squares(asset, site, joints):
    jacobian = _pose(asset, site, placed(asset, joints)[1].qpos)[2]
    twist = np.array([0.1, -0.05, 0.02, 0.0, 0.1, 0.0])
    desired = np.array([0.3, -0.2, 0.5, 0.1, -0.4, 0.2, 0.3])
    inverted = np.linalg.pinv(jacobian)
    exact = damped_inverse(jacobian, twist, 1e-4, jnp.zeros(7))
    np.testing.assert_allclose(exact, inverted @ twist, atol=2e-4)
    near = damped_inverse(jacobian, twist, 1e-4, desired)
    free = desired - inverted @ (jacobian @ desired)  # its part in the null space
    np.testing.assert_allclose(near, inverted @ twist + free, atol=1e-3)
    assert np.linalg.norm(free) > 0.1
    straight = np.array([0.1, -0.05, 0.02, 0.0, 0.0, 0.0])
    moved = jacobian @ damped_inverse(jacobian, straight, 0.02, jnp.zeros(7))
    assert np.linalg.norm(moved - straight) < 0.01 * np.linalg.norm(straight)


def test_rotations():
    rng = np.random.default_rng(0)
    r, s = (jnp.asarray(q / np.linalg.norm(q), jnp.float32) for q in rng.normal(size=(2, 4)))
    v = jnp.asarray(rng.normal(size=3), jnp.float32)
    product, rotated = np.empty(4), np.empty(3)
    mujoco.mju_mulQuat(product, np.asarray(r, float), np.asarray(s, float))
    mujoco.mju_rotVecQuat(rotated, np.asarray(v, float), np.asarray(r, float))
    np.testing.assert_allclose(quat_multiply(r, s), product, atol=1e-6)
    np.testing.assert_allclose(rotate(r, v), rotated, atol=1e-6)
    np.testing.assert_allclose(rotate(inverse(r), rotate(r, v)), v, atol=1e-6)
    small = jnp.array([1.0, 0.005, -0.01, 0.002])  # 0.01, -0.02, 0.004 rad
    target = quat_multiply(small / jnp.linalg.norm(small), r)
    np.testing.assert_allclose(rotate_towards(r, -target, 5.0), [0.05, -0.1, 0.02], atol=1e-4)


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
