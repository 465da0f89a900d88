"""How a robot is drawn whose author wrote neither light nor sky nor camera."""

from dataclasses import dataclass

import jax.numpy as jnp
import mujoco
import numpy as np
import pytest

from hybrid_rl.analysis import drawing
from hybrid_rl.envs.adapters.gymnasium import GymnasiumEnv
from hybrid_rl.envs.mujoco import mjcf, scenery
from hybrid_rl.envs.mujoco.physics import Physics
from hybrid_rl.envs.mujoco.simplified import simplified
from hybrid_rl.types import EnvState, Spec

ACROBOT = """
<mujoco model="acrobot">
  <option timestep="0.01"><flag autoreset="disable"/></option>
  <worldbody>
    <geom type="plane" size="5 5 0.1"/>
    <body pos="0 0 2.5">
      <joint name="shoulder" axis="0 1 0"/>
      <geom type="capsule" fromto="0 0 0 0 0 -1" size="0.05" rgba="1 0 0 1" contype="0"/>
      <body pos="0 0 -1">
        <joint name="elbow" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -1" size="0.05" rgba="1 0 0 1" contype="0"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor joint="elbow" gear="2"/></actuator>
</mujoco>
"""


@dataclass(frozen=True)
class Acrobot:
    """Without `scene` and `pose`."""

    spec: Spec = Spec(obs=4, act=1, dt=0.05)

    def reset(self, key):
        return self._state(Physics(ACROBOT).reset(jnp.array([0.5, 0.5]), jnp.zeros(2)))

    def step(self, state, action):
        return self._state(Physics(ACROBOT).step(state.data, action, 5))

    def _state(self, data):
        return EnvState(data, jnp.concatenate((data.qpos, data.qvel)), data.qpos[0])


def test_a_robot_without_light_is_drawn_bright_before_a_sky(can_draw):
    model = scenery.dressed(ACROBOT)
    assert (model.nlight, model.ntex) == (1, 1)
    if not can_draw:
        return
    env = GymnasiumEnv(Acrobot(), steps=1)
    env.reset(seed=0)
    picture = env.render().astype(int)
    env.close()
    red = picture[..., 0] > 2 * picture[..., 1:].max(-1) + 10
    assert picture[red][:, 0].mean() > 100
    assert picture[0].min() > 100  # the sky


def test_a_floor_is_as_bright_as_its_texture_under_geoms_that_are_dark_by_default(can_draw):
    """Go1's file has no light and nearly black geoms; the camera follows to 25 m."""
    if not can_draw:
        pytest.skip("nothing draws here")
    scene = simplified("go1.xml", free=True)
    pose = mjcf.load(scene).key_qpos[0] + 25 * (np.arange(19) == 0)
    (picture,) = drawing.frames(scene, pose[None], 64, 48)
    floor = picture[-1].astype(int)
    assert floor.min() > 60
    trunk = picture[16:32, 24:40].min(-1)
    assert trunk.max() > 150


@pytest.mark.parametrize("asset", ["halfcheetah.xml", "lander.xml"])
def test_a_scene_with_light_and_sky_stays_as_it_is(asset):
    written, drawn = mjcf.load(asset), scenery.dressed(mjcf.text(asset))
    assert (drawn.nlight, drawn.ntex) == (written.nlight, written.ntex)
    np.testing.assert_array_equal(drawn.geom_rgba, written.geom_rgba)
    assert scenery.camera(drawn).type == mujoco.mjtCamera.mjCAMERA_FIXED
