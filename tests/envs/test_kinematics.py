"""Arms against their makers' tables, and their kinematics against MuJoCo C."""

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
    stay_within,
)
from hybrid_rl.envs.panda_stack import READY
from hybrid_rl.envs.sawyer_push import HOME

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
MASSES = {  # [kg]: names, then masses
    SAWYER: (
        "base l0 l1 l2 l3 l4 l5 l6 rod cube",
        (2.0687, 5.3213, 4.505, 1.745, 2.5097, 1.1136, 1.5625, 0.3292, 0.05, 0.1),
    ),
    PANDA: (
        "link0 link1 link2 link3 link4 link5 link6 link7 hand left_finger right_finger block base",
        (
            *(0.629769, 4.970684, 0.646926, 3.228604, 3.587895, 1.225946, 1.666555, 0.735522),
            *(0.73, 0.015, 0.015, 0.1, 0.1),
        ),
    ),
}
LIMITS = {  # lower, upper [rad]; velocity [rad/s]; torque [N m]
    SAWYER: [
        (-3.0503, 3.0503, 1.74, 80),
        (-3.8095, 2.2736, 1.328, 80),
        (-3.0426, 3.0426, 1.957, 40),
        (-3.0439, 3.0439, 1.957, 40),
        (-2.9761, 2.9761, 3.485, 9),
        (-2.9761, 2.9761, 3.485, 9),
        (-4.7124, 4.7124, 4.545, 9),
    ],
    PANDA: [
        (-2.8973, 2.8973, 2.175, 87),
        (-1.7628, 1.7628, 2.175, 87),
        (-2.8973, 2.8973, 2.175, 87),
        (-3.0718, -0.0698, 2.175, 87),
        (-2.8973, 2.8973, 2.61, 12),
        (-0.0175, 3.7525, 2.61, 12),
        (-2.8973, 2.8973, 2.61, 12),
    ],
}
PRINCIPAL = {  # moments of inertia [kg m^2], descending
    "l0": (0.06516, 0.05109, 0.01862),
    "l1": (0.02243, 0.02216, 0.00971),
    "l2": (0.02579, 0.02551, 0.00293),
    "l3": (0.01024, 0.00970, 0.00370),
    "l4": (0.01365, 0.01355, 0.00127),
    "l5": (0.00474, 0.00423, 0.00191),
    "l6": (0.00036, 0.00031, 0.00021),
}


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


@pytest.mark.parametrize("asset", MASSES)
def test_masses_and_moments_of_inertia(asset):
    model, (names, masses) = mjcf.load(asset), MASSES[asset]
    found = {model.body(i).name: model.body(i).mass[0] for i in range(1, model.nbody)}
    assert found == pytest.approx(dict(zip(names.split(), masses, strict=True)))
    for name, moments in PRINCIPAL.items() if asset == SAWYER else ():
        inertia = sorted(model.body(name).inertia, reverse=True)
        np.testing.assert_allclose(inertia, moments, atol=6e-6, err_msg=name)


@pytest.mark.parametrize("asset", LIMITS)
def test_limits(asset):
    model, (low, high, speed, torque) = mjcf.load(asset), np.transpose(LIMITS[asset])
    np.testing.assert_allclose(model.jnt_range[:7], np.stack((low, high), 1))
    np.testing.assert_allclose(model.actuator_ctrlrange[:7], np.stack((-speed, speed), 1))
    np.testing.assert_allclose(model.actuator_forcerange[:7], np.stack((-torque, torque), 1))
    assert model.jnt_limited[:7].all()
    assert model.actuator_forcelimited[:7].all()


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


def test_stay_within_stops_only_outward_motion():
    low, high = jnp.zeros(4), jnp.ones(4)
    velocity, position = jnp.array([1.0, -1.0, 1.0, -1.0]), jnp.array([1.5, 1.5, -0.5, -0.5])
    np.testing.assert_array_equal(stay_within(velocity, position, low, high), [0.0, -1.0, 1.0, 0.0])
