"""How a robot is drawn whose author wrote neither light nor sky nor camera."""

from dataclasses import dataclass

import jax.numpy as jnp
import mujoco
import numpy as np
import pytest

from hybrid_rl.envs.adapters.gymnasium import GymnasiumEnv
from hybrid_rl.envs.mujoco import mjcf, scenery
from hybrid_rl.envs.mujoco.physics import Physics
from hybrid_rl.types import EnvState, Spec

ACROBOT = """
<mujoco model="acrobot">
  <option timestep="0.01"><flag autoreset="disable"/></option>
  <worldbody>
    <geom type="plane" size="5 5 0.1"/>
    <body pos="0 0 2.5">
      <joint name="shoulder" axis="0 1 0"/>
      <geom type="capsule" fromto="0 0 0 0 0 -1" size="0.05" {rgba} contype="0"/>
      <body pos="0 0 -1">
        <joint name="elbow" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -1" size="0.05" {rgba} contype="0"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor joint="elbow" gear="2"/></actuator>
</mujoco>
"""
RED, PLAIN = ACROBOT.format(rgba='rgba="1 0 0 1"'), ACROBOT.format(rgba="")


@dataclass(frozen=True)
class Acrobot:
    """Without `scene` and `pose`."""

    spec: Spec = Spec(obs=4, act=1, dt=0.05)

    def reset(self, key):
        return self._state(Physics(RED).reset(jnp.array([0.5, 0.5]), jnp.zeros(2)))

    def step(self, state, action):
        return self._state(Physics(RED).step(state.data, action, 5))

    def _state(self, data):
        obs, no = jnp.concatenate((data.qpos, data.qvel)), jnp.zeros((), bool)
        return EnvState(data, obs, data.qpos[0], no, no, {}, {})


def robot(env):
    """The picture of an environment at the start, and where [480, 640] it shows the robot."""
    env.reset(seed=0)
    picture = env.render().astype(int)
    env.close()
    return picture, picture[..., 0] > 2 * picture[..., 1:].max(-1) + 10


def test_a_robot_without_light_is_bright_and_fills_the_picture(monkeypatch, can_draw):
    """More than MuJoCo alone shows it, against a sky that is no longer black."""
    if not can_draw:
        return
    picture, shown = robot(GymnasiumEnv(Acrobot(), steps=1))
    with monkeypatch.context() as bare:
        bare.setattr(scenery, "dressed", lambda scene: mjcf.spec(scene).compile())
        bare.setattr(scenery, "ELEVATION", -90.0)  # MuJoCo's own is above it
        dark, small = robot(GymnasiumEnv(Acrobot(), steps=1))
    assert picture[shown].mean() > dark[small].mean()
    assert picture[0].min() > dark[0].max()
    rows, columns = np.nonzero(shown)
    assert min(rows.min(), columns.min()) > 0
    assert rows.max() < 479
    assert columns.max() < 639
    assert np.ptp(rows) > 480 / 2


def test_a_model_has_the_scenery_that_its_author_left_out():
    model = scenery.dressed(PLAIN)
    assert (model.nlight, model.ntex) == (1, 1)
    np.testing.assert_allclose(model.geom_rgba, [scenery.GROUND, scenery.ROBOT, scenery.ROBOT])
    np.testing.assert_allclose(scenery.dressed(RED).geom_rgba[1:], [[1, 0, 0, 1]] * 2)


@pytest.mark.parametrize("asset", ["halfcheetah.xml", "lander.xml"])
def test_a_scene_with_light_and_sky_stays_as_it_is(asset):
    written, drawn = mjcf.load(asset), scenery.dressed(mjcf.text(asset))
    assert (drawn.nlight, drawn.ntex) == (written.nlight, written.ntex)
    np.testing.assert_array_equal(drawn.geom_rgba, written.geom_rgba)
    assert scenery.camera(drawn).type == mujoco.mjtCamera.mjCAMERA_FIXED
