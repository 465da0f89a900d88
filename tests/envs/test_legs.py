"""Robots of any file: what is kept of it, and a robot that walks by command."""

import sys
from types import SimpleNamespace

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import jitted

from hybrid_rl.envs.legs import HOLD, Legs
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.simplified import located, simplified
from hybrid_rl.errors import UsageError
from hybrid_rl.types import Spec

LEG = """<body name="{0}" pos="{1} {2} 0">
  <joint name="{0}_hip" axis="0 1 0" range="-1 1" damping="0.1"/>
  <geom type="capsule" size="0.02" fromto="0 0 0 0 0 -0.2"/>
  <body pos="0 0 -0.2">
    <joint name="{0}_knee" axis="0 1 0" range="-2 0"/>
    <geom size="0.01" type="capsule" fromto="0 0 0 0 0 -0.18"/>
    <geom name="{0}_foot" size="0.03" pos="0 0 -0.2"/>
  </body>
</body>"""
CORNERS = {"fl": (0.2, 0.1), "fr": (0.2, -0.1), "rl": (-0.2, 0.1), "rr": (-0.2, -0.1)}
LEGS = "".join(LEG.format(name, *corner) for name, corner in CORNERS.items())
MOTORS = "".join(
    f'<motor joint="{name}_hip" gear="5" ctrlrange="-4 4"/><motor joint="{name}_knee" '
    'ctrlrange="-99 99" forcerange="-10 10"/>'
    for name in CORNERS
)
TABLE = f"""<mujoco>
  <compiler autolimits="true" angle="radian"/>
  <asset>
    <mesh name="lid" vertex="0 0 0  0.2 0 0  0 0.1 0  0 0 0.1"/>
    <material name="red" rgba="1 0 0 1"/>
  </asset>
  <worldbody>
    <geom type="plane" size="1 1 1" pos="0 0 -3"/>
    <body name="base" pos="0 0 1">
      <freejoint/> <geom type="box" size="0.2 0.1 0.03" material="red"/>
      <geom type="mesh" mesh="lid" contype="0" conaffinity="0"/> {LEGS}
    </body>
  </worldbody>
  <actuator>{MOTORS}</actuator>
  <sensor><gyro site="imu"/></sensor>
  <keyframe>
    <key name="other" qpos="0 0 1 1 0 0 0 0 0 0 0 0 0 0 0"/>
    <key name="home" qpos="0 0 1 1 0 0 0 0.5 -1 0.5 -1 0.5 -1 0.5 -1"/>
  </keyframe>
</mujoco>""".replace("<freejoint/>", '<freejoint/> <site name="imu"/>')


@pytest.fixture(scope="module")
def env():
    return Legs(robot=TABLE, physics="native")


def test_a_file_is_reduced_to_bodies_servos_feet_and_a_floor():
    given, model = mujoco.MjModel.from_xml_string(TABLE), mjcf.load(simplified(TABLE, True))
    for name in ("body_mass", "body_inertia", "body_ipos", "jnt_range", "body_pos"):
        np.testing.assert_allclose(getattr(model, name), getattr(given, name), atol=1e-5)
    assert (model.nmesh, model.nsensor, model.nkey, model.npair) == (0, 0, 1, 0)
    np.testing.assert_allclose(model.actuator_gainprm[:2, 0], [20 / 0.5, 10 / 0.5])  # t / 0.5 rad
    np.testing.assert_allclose(model.actuator_forcerange[:2], [[-20, 20], [-10, 10]])
    np.testing.assert_allclose(model.actuator_ctrlrange[:2], [[-1, 1], [-2, 0]])
    np.testing.assert_allclose(model.dof_damping[6:8], [0.1 + 0.02 * 40, 0.02 * 20])
    touching = [model.geom(i).name for i in range(model.ngeom) if model.geom_conaffinity[i]]
    assert touching == [f"{name}_foot" for name in CORNERS]
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose([data.geom(name).xpos[2] for name in touching], 0.03, atol=1e-5)
    assert data.qpos[2] == pytest.approx(0.2 * np.cos(0.5) * 2 + 0.03, abs=1e-5)
    again = mjcf.load(simplified(simplified(TABLE, True), True))
    assert again.body_mass == pytest.approx(model.body_mass)
    without = mjcf.load(simplified(TABLE.replace('ctrlrange="-4 4"', ""), True))  # a limit
    np.testing.assert_allclose(without.actuator_forcerange[:2], [[-5, 5], [-10, 10]])


def test_a_robot_without_a_free_base_or_motors_is_one_line():
    for robot in ("panda.xml", TABLE.replace(MOTORS, "")):
        with pytest.raises(UsageError, match="must have a free base, <freejoint/>, and motors"):
            Legs(robot=robot)


def test_a_name_is_a_robot_of_the_menagerie_which_is_never_downloaded(tmp_path, monkeypatch):
    (tmp_path / "table.xml").write_text(TABLE)
    robot = SimpleNamespace(default_model="table", xml=lambda entry: tmp_path / f"{entry}.xml")
    cache, robots = SimpleNamespace(root=None, is_cached=lambda _: False), {"table": robot}
    with pytest.raises(UsageError, match=r"robot=table: .*hybrid_rl\[menagerie\]"):
        located("table")  # not installed here
    package = SimpleNamespace(get=robots.__getitem__, Cache=lambda: cache)
    monkeypatch.setitem(sys.modules, "mujoco_menagerie", package)
    with pytest.raises(UsageError, match="mujoco-menagerie prefetch table"):
        located("table")
    with pytest.raises(UsageError, match="robot=chair: 'chair'"):
        located("chair")
    cache.root = tmp_path
    assert Legs(robot="table").spec == Spec(36, 8, 0.02)


def test_a_file_of_ours_comes_before_one_of_its_name_here(tmp_path, monkeypatch):
    for name in ("go1.xml", "mine.xml"):
        (tmp_path / name).write_text(TABLE)
    monkeypatch.chdir(tmp_path)
    assert [located(name) for name in ("go1.xml", "mine.xml")] == [
        "go1.xml",
        str(tmp_path / "mine.xml"),
    ]


def test_it_stands_and_follows_no_command(env):
    state = jitted(env, "reset")(jax.random.key(0))
    state = state.replace(data=state.data.replace(qvel=jnp.zeros(14)))
    state = env.commanded(state, jnp.zeros(3))
    for _ in range(100):
        state = jitted(env, "step")(state, jnp.zeros(8))
        assert not state.terminated
    assert 1.9 < state.reward <= 2.0
    blind = jitted(env, "step")(state.replace(obs=state.obs * 0), jnp.zeros(8))  # as on the page
    assert blind.reward == pytest.approx(float(state.reward), abs=1e-3)
    np.testing.assert_allclose(state.obs[6:9], [0, 0, -1], atol=0.02)
    assert state.data.qpos[2] > 0.9 * env._body.model.key_qpos[0, 2]


def test_a_command_lasts_for_five_seconds_or_to_the_end(env):
    first = jitted(env, "reset")(jax.random.key(3))
    commands, shown = np.asarray(first.info["commands"]), []
    state = first.replace(info=first.info | {"count": jnp.int32(0)})
    for count in (0, HOLD - 2, 2 * HOLD - 1, 4 * HOLD - 1):
        state = state.replace(info=state.info | {"count": jnp.int32(count)})
        shown.append(jitted(env, "step")(state, jnp.zeros(8)).obs[-3:])
    np.testing.assert_array_equal(shown, commands[[0, 0, 2, 0]])
    assert len(np.unique(commands, axis=0)) == 4
    given = env.commanded(first, jnp.array([0.1, 0.2, 0.3]))
    after = jitted(env, "step")(given, jnp.zeros(8))
    np.testing.assert_allclose([given.obs[-3:], after.obs[-3:]], [[0.1, 0.2, 0.3]] * 2)
    np.testing.assert_array_equal(given.obs[:-3], first.obs[:-3])


def test_what_it_observes_is_in_the_frame_of_its_base(env):
    """Lying on its left side while it falls: gravity and velocity point to its left."""
    state = jitted(env, "reset")(jax.random.key(0))
    qpos = state.data.qpos.at[2].set(9.0).at[3:7].set(jnp.array([1, -1, 0, 0]) / 2**0.5)
    data = state.data.replace(qpos=qpos, qvel=jnp.zeros(14).at[2].set(-2.0))
    after = jitted(env, "step")(state.replace(data=data), jnp.zeros(8))
    fallen = 2.0 + 9.81 * 0.02
    np.testing.assert_allclose(after.obs[:3], [0, fallen, 0], atol=0.01)
    np.testing.assert_allclose(after.obs[6:9], [0, 1, 0], atol=0.01)
    assert after.terminated
    assert after.reward == 0


def test_the_reward_is_that_of_its_equation(env):
    rng = np.random.default_rng(0)
    x, after, u = rng.normal(size=36) / 9, rng.normal(size=36) / 9, rng.uniform(-0.3, 0.3, 8)
    model, away = env._body.model, after[9:17]
    torque = np.clip(model.actuator_gainprm[:, 0] * (u / 2 - away), *model.actuator_forcerange.T)
    power = np.abs(torque * 10 * after[17:25]).sum()
    squares = {0.5: after[2:3], 0.05: np.concatenate((after[3:5], u - x[-11:-3])), 5.0: after[6:8]}
    want = np.exp(-4 * ((after[:2] - x[-3:-1]) ** 2).sum()) + np.exp(-(away**2).sum() / 4) / 2
    want += np.exp(-4 * (after[5] - x[-1]) ** 2) / 2 - power / (10 * model.body_mass.sum() * 9.81)
    want -= sum(weight * (each**2).sum() for weight, each in squares.items())
    assert want > 0
    got = env.reward_of(*(jnp.asarray(each, jnp.float32) for each in (x, u, after)))
    assert got == pytest.approx(want, rel=1e-5)
