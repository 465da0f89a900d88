"""Arms of any file: the tip, the pose to reach, and the way there."""

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import jitted

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.reach import STRIDE, Reach
from hybrid_rl.errors import UsageError
from hybrid_rl.types import Spec

ARM = """<mujoco>
  <compiler autolimits="true" angle="radian"/>
  <worldbody>
    <body pos="0 0 0.5">
      <joint name="a" axis="0 0 1" range="0.2 2"/>
      <geom size="0.03" fromto="0 0 0 0.3 0 0" type="capsule"/>
      <body pos="0.3 0 0">
        <joint name="b" axis="0 1 0"/> <geom size="0.03" fromto="0 0 0 0.3 0 0" type="capsule"/>
        <body name="hand" pos="0.3 0 0">
          <geom size="0.03"/> <site name="nail" pos="0.1 0 0"/> <site/>
          <body><joint name="grip" type="slide" range="0 0.1"/> <geom size="0.01"/></body>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position joint="a" kp="200" kv="20"/> <motor joint="b" ctrlrange="-50 50"/>
    <position joint="grip" kp="9"/>
  </actuator>
</mujoco>"""


def steered(env, state, goal, decisions):
    """The state after these decisions, in which servos move to angles or positions `goal`."""
    for _ in range(decisions):
        u = jnp.clip((jnp.asarray(goal, jnp.float32) - state.info["servos"]) / STRIDE, -1, 1)
        state = jitted(env, "step")(state, u)
    return state


@pytest.mark.parametrize(
    ("robot", "site", "tip"),
    [
        (ARM, "tip", 0.6),  # the frame of a hand
        (ARM, "nail", 0.7),
        (ARM.replace("nail", "tip"), "tip", 0.7),  # of the file
        (ARM.replace("<site/>", ""), "tip", 0.7),  # the hand's only site
        (ARM.replace('"hand" pos="0.3 0 0">', '"hand"><joint/>'), "tip", 0.63),  # the link's end
    ],
)
def test_the_tip_is_a_site_or_the_end_of_the_last_link_and_home_is_within_ranges(robot, site, tip):
    env = Reach(robot=robot, site=site)
    model = mjcf.load(env._asset)
    assert env.spec == Spec(4 * 2 + 6, 2, 0.02)
    np.testing.assert_allclose(model.key_qpos[0], [1.1] + (model.nq - 1) * [0])
    p, _ = env._tip(jnp.asarray(model.key_qpos[0], jnp.float32))
    np.testing.assert_allclose(p, [tip * np.cos(1.1), tip * np.sin(1.1), 0.5], atol=1e-6)


def test_a_site_that_is_not_there_and_a_free_base_are_one_line():
    with pytest.raises(UsageError, match=r"env\.site=nosite: choose one of tip, nail"):
        Reach(robot=ARM, site="nosite")
    with pytest.raises(UsageError, match=r"env\.site=still: no servo moves it"):
        Reach(robot=ARM.replace("<worldbody>", '<worldbody><site name="still"/>'), site="still")
    with pytest.raises(UsageError, match=r"robot=go1\.xml: must have a fixed base"):
        Reach(robot="go1.xml")


def test_slides_alone_are_an_arm_and_no_pose_is_out_of_their_ranges():
    """Also where a servo has no range of its own, as on the first of two rails."""
    robot = ARM.replace('<position joint="grip" kp="9"/>', "").replace("0.2 2", "0.2 0.9")
    robot = robot.replace('"a" axis="0 0 1"', '"a" type="slide" axis="1 0 0"')
    robot = robot.replace('"b" axis', '"b" type="slide" range="-0.1 0.3" axis')
    env = Reach(robot=robot, physics="native")
    for seed in range(3):
        state = jitted(env, "reset")(jax.random.key(seed))
        goal = state.info["servos"] + (state.info["target"][:3] - env._tip(state.data.qpos)[0])[:2]
        assert steered(env, state, goal, 150).metrics["success"] == 1


def test_a_last_slide_that_moves_the_site_is_part_of_the_arm():
    """As that of a SCARA, which brings the tip to the height of the pose."""
    quill = '<geom size="0.01"/> <site name="quill"/>'
    robot = ARM.replace('<geom size="0.01"/>', quill).replace('kp="9"', 'kp="20" kv="0.5"')
    robot = robot.replace('"b" axis="0 1 0"', '"b" axis="0 0 1"')
    robot = robot.replace('"grip" type="slide" range="0 0.1"', '"grip" type="slide" range="-1 1"')
    env = Reach(robot=robot, site="quill", physics="native")
    assert (env.spec.act, Reach(robot=robot).spec.act) == (3, 2)
    state = jitted(env, "reset")(jax.random.key(0))
    x, y, z, w, _, _, turn = state.info["target"]
    yaw = 2 * np.arctan2(turn, w)  # of the second link
    a = np.arctan2(y - 0.3 * np.sin(yaw), x - 0.3 * np.cos(yaw))
    goal = jnp.array([a, yaw - a, z - 0.5])
    assert abs(goal[2]) > 0.1
    assert steered(env, state, goal, 100).metrics["success"] == 1


def test_servos_that_move_to_the_angles_of_the_pose_reach_it():
    """And the reward is then 1.5, its largest value, while actions rest."""
    env = Reach(robot=ARM, physics="native")
    start = jitted(env, "reset")(jax.random.key(1))
    target, data = start.info["target"], mujoco.MjData(mjcf.load(env.scene()))
    goal = np.array([np.arctan2(target[1], target[0]), 0.0])
    goal[1] = np.arcsin(np.clip((0.5 - target[2]) / 0.3, -1, 1))
    state = steered(env, start, goal, 100)
    assert state.metrics["success"] == 1
    assert 1.4 < state.reward <= 1.5
    assert start.metrics["success"] == 0
    np.testing.assert_allclose(state.obs[6:9], target[:3] - env._tip(state.data.qpos)[0], atol=1e-6)
    data.qpos[:] = env.pose(state)
    mujoco.mj_kinematics(mjcf.load(env.scene()), data)
    np.testing.assert_allclose(data.body("target").xpos, target[:3], atol=1e-6)
    np.testing.assert_allclose(data.body("hand").xpos, target[:3], atol=0.02)
