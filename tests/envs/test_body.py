"""Changed bodies, for good and of an episode, against models that MuJoCo compiles so."""

from functools import cache
from operator import attrgetter

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import DECISIONS, TASKS, TOUCHING, actions, jitted, make, placed, rollout

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.body import Body
from hybrid_rl.envs.mujoco.physics import Physics

ROBOTS = tuple(task for task, kind in TASKS.items() if issubclass(kind, Body))
DERIVED = ("body_subtreemass", "body_invweight0", "dof_invweight0", "dof_M0", "actuator_acc0")


def compiled(task, factor, payload):
    """The model of a task that MuJoCo compiles from geoms and inertias of other masses."""
    spec = mjcf.spec(make(task)._body.asset)
    for geom in spec.geoms:
        geom.mass, geom.density = geom.mass * factor, geom.density * factor
    for body in spec.bodies:
        if body.explicitinertial:
            body.mass, body.inertia = body.mass * factor, body.inertia * factor
    root = spec.bodies[1]
    if root.explicitinertial:
        root.mass += payload
    elif payload:
        centre = spec.compile().body_ipos[1]
        at = {"type": mujoco.mjtGeom.mjGEOM_SPHERE, "size": [1e-3, 0, 0], "pos": centre}
        root.add_geom(**at, mass=payload, contype=0, conaffinity=0)
    return spec.compile()


@pytest.mark.parametrize("task", ROBOTS)
def test_masses_and_all_that_follows_are_those_of_a_compiled_model(task):
    """Friction is multiplied alone; without a change it is the same object."""
    now = make(task, mass=1.5, payload=0.5, friction=0.5)._body.model
    plain, then = mjcf.load(make(task)._body.asset), compiled(task, 1.5, 0.5)
    for name in ("body_mass", "body_inertia", *DERIVED):
        expected = getattr(then, name)
        np.testing.assert_allclose(getattr(now, name), expected, 1e-5, 1e-6, err_msg=name)
    assert now.stat.meaninertia == pytest.approx(then.stat.meaninertia)
    np.testing.assert_allclose(now.geom_friction, plain.geom_friction * [0.5, 1, 1])
    np.testing.assert_allclose(now.pair_friction, plain.pair_friction * [0.5, 0.5, 1, 1, 1])
    assert make(task, mass=1, motors=[1.0] * make(task).spec.act)._body.model is plain


@pytest.mark.parametrize("task", [task for task in ROBOTS if task not in ("legs", "reach")])
def test_a_weak_motor_is_a_smaller_action(task):
    """In the same state, but for servos; other motors, and the drag of the quadcopter, stay."""
    factors = np.ones(make(task).spec.act, np.float32)
    factors[-1] = 0.5
    action = np.linspace(0.3, 0.9, len(factors), dtype=np.float32)
    weak, half = make(task, motors=factors), make(task, motors=0.5)
    state = make(task).reset(jax.random.key(0))
    for env, smaller in ((weak, action * factors), (half, action * 0.5)):
        own = state.replace(data=env.reset(jax.random.key(0)).data)
        now = jitted(env, "step")(own, action).data.qvel
        np.testing.assert_array_equal(now, jitted(make(task), "step")(state, smaller).data.qvel)


@pytest.mark.parametrize("task", [pytest.param(task, id=f"{task}-mjx") for task in ROBOTS])
def test_mjx_moves_as_mujoco_c(task):
    """From each state that MuJoCo C reaches; most robots only with `--slow`: they compile long."""
    motors = np.linspace(0.5, 1.0, make(task).spec.act)
    change = {"mass": 1.3, "friction": 0.5, "motors": motors, "payload": 0.5}
    native, mjx = (make(task, each, **change) for each in ("native", "mjx"))
    path, each = rollout(native), actions(native)[TOUCHING]
    assert np.abs(path.obs - rollout(make(task)).obs)[TOUCHING].max() > 1e-2
    for t in range(DECISIONS - 1):
        now, then = (jax.tree.map(lambda x, i=i: x[TOUCHING][i], path) for i in (t, t + 1))
        after = jitted(mjx, "step")(now, each[t + 1])
        np.testing.assert_allclose(after.obs, then.obs, atol=1e-3)  # measured: at most 2e-4


RIG = """
<mujoco>
  <option timestep="0.002"><flag autoreset="disable"/></option>
  <worldbody>
    <geom name="floor" type="plane" size="0 0 1" friction="0.3"/>
    <body pos="0 0 0.05">
      <joint type="slide" axis="1 0 0"/> <joint type="slide" axis="0 0 1"/>
      <geom type="sphere" size="0.05" mass="1" friction="0.3"/>
      <body pos="0 0 0.1">
        <joint name="hinge" axis="0 1 0" stiffness="1" damping="0.1" armature="0.01"
          frictionloss="0.1"/>
        <geom type="capsule" size="0.02" fromto="0 0 0 0.1 0 0.3" mass="0.5" contype="0"/>
        <site name="tip" pos="0.1 0 0.3"/>
      </body>
    </body>
    <body pos="0 2 0.05"> <joint type="slide" axis="1 0 0"/> <joint type="slide" axis="0 0 1"/>
      <geom name="ball" type="sphere" size="0.05" mass="1" contype="0"/>
    </body>
  </worldbody>
  <contact><pair geom1="floor" geom2="ball" friction="0.3 0.3 0.005 0.0001 0.0001"/></contact>
  <actuator><position joint="hinge" kp="5" kv="0.2" forcerange="-4 4"/></actuator>
  <sensor>
    <jointvel joint="hinge"/>
    <framepos name="tip" objtype="site" objname="tip"/>
    <framelinvel objtype="site" objname="tip"/>
  </sensor>
</mujoco>
"""


@cache
def pushed(physics):
    """The function fields, height -> states before and after 40 physics steps of sliding."""

    def after(fields, height):
        qpos = jnp.zeros(5).at[jnp.array([1, 4])].set(height)
        speed = jnp.array([2.0, 0, 0, 2, 0])
        start = physics.reset(qpos, speed, fields)
        return start, physics.step(start, jnp.ones(1), 40)

    return jax.jit(after)


def of_mujoco(name, factor, height):
    """The velocities [nv] that `pushed` should reach, by MuJoCo's own loop; a field by a factor."""
    model = mujoco.MjModel.from_xml_string(RIG)
    attrgetter(name)(model)[:] *= factor
    mujoco.mj_setConst(model, mujoco.MjData(model))
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:], data.ctrl[:] = [0, height, 0, 0, height], [2, 0, 0, 2, 0], 1
    mujoco.mj_step(model, data, 40)
    return data.qvel


@pytest.mark.parametrize("implementation", ["native", "mjx"])
def test_each_field_that_an_episode_has_for_itself_acts_as_in_mujoco(implementation):
    """And sensors are those of the state.

    MJX: a mass in the air, since on the floor its contacts are those of the model's masses.
    """
    physics = Physics(RIG, implementation)
    after = pushed(physics)
    own = {n: jnp.asarray(attrgetter(n)(physics.model), jnp.float32) for n in mjcf.FIELDS}
    for state in after(own, 0.0):
        sensed = placed(RIG, state.qpos, state.qvel)[1].sensordata
        np.testing.assert_allclose(state.sensors, sensed, atol=1e-5)
        np.testing.assert_array_equal(physics.sensor(state, "tip"), state.sensors[1:4])
    for name in mjcf.FIELDS:
        height = 1.0 if (implementation, name) == ("mjx", "body_mass") else 0.0
        factor = 0.5 if name == "opt.gravity" else 1.5
        plain, expected = (of_mujoco(name, each, height) for each in (1.0, factor))
        assert np.abs(expected - plain).max() > 0.01, name
        found = after({**own, name: factor * own[name]}, height)[1].qvel
        np.testing.assert_allclose(found, expected, atol=2e-4, err_msg=name)  # measured: 6e-5


def test_environments_side_by_side_keep_their_own_bodies():
    """Also where the order changes from one call to the next."""
    physics = Physics(RIG, "native")
    masses = np.array([1.0, 2.0, 3.0], np.float32)[:, None] * physics.model.body_mass
    together = jax.jit(jax.vmap(lambda mass: pushed(physics)({"body_mass": mass}, 0.0)[1].qvel))
    masses = masses.astype(np.float32)
    alone = [pushed(physics)({"body_mass": mass}, 0.0)[1].qvel for mass in masses]
    assert len({float(speed[2]) for speed in alone}) == 3
    for order in ([0, 1, 2], [2, 1, 0], [2, 0, 0]):
        found = together(masses[order])
        np.testing.assert_array_equal(found, np.stack([alone[i] for i in order]))
