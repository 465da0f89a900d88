"""Any robot's MJCF, reduced to what learning needs: bodies, joints, servos, feet and a floor.

    inertias   as compiled, so that meshes can go; a mesh that collides is drawn as a capsule
    servos     tau = k (u - q), |tau| <= t: those of the file; in place of a motor of torque t one
               with k = t / 0.5 rad, and damping of its joint: 0.02 s k, or that of a servo of speed
    contacts   the feet of a free robot with the floor, and no others
    home       keyframe `home`, else the first one, else qpos0, or the middle of a joint's range if
               that is out of it; a free robot is put on the floor

A robot is a file of `assets`, a path, MJCF text, or a name of MuJoCo Menagerie, whose package is
asked where it has the file, but not to download it. Feet are the geoms that collide and whose
lowest points are within 1 cm of the lowest one at home.
"""

from functools import cache
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.scenery import CAMERA
from hybrid_rl.errors import UsageError, install

TIMESTEP = 0.004  # [s]
OFFSET = 0.5  # [rad] from its target at which a servo in place of a motor has its whole torque
DAMPING = 0.02  # [s] its damping over its stiffness
LEVEL = 0.01  # [m] of the feet, above the lowest one
JOINT, FREE = mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtJoint.mjJNT_FREE
GEOM = mujoco.mjtGeom
CAPSULE, PLANE, MESH = GEOM.mjGEOM_CAPSULE, GEOM.mjGEOM_PLANE, GEOM.mjGEOM_MESH


class Servos(NamedTuple):
    """The motors of a model: their joints, and their targets [rad] at home and in their range."""

    qpos: np.ndarray  # [m] addresses
    qvel: np.ndarray  # [m]
    home: np.ndarray  # [m]
    low: np.ndarray  # [m]
    high: np.ndarray  # [m]


@cache
def servos(asset: str, count: int | None = None) -> Servos:
    """The first `count` servos of a simplified model; None: all."""
    model = mjcf.load(asset)
    joints, limited = model.actuator_trnid[:count, 0], model.actuator_ctrllimited[:count] > 0
    own = np.where(model.jnt_limited > 0, model.jnt_range.T, [[-np.inf], [np.inf]])[:, joints]
    low, high = np.where(limited, model.actuator_ctrlrange[:count].T, own)
    angles = (x.astype(np.float32) for x in (model.key_ctrl[0, :count], low, high))
    return Servos(model.jnt_qposadr[joints], model.jnt_dofadr[joints], *angles)


def located(robot: str) -> str:
    """The name of a robot's model for `mjcf.spec`."""
    if robot.rstrip().endswith("</mujoco>"):
        return robot
    if robot.endswith(".xml"):
        ours = (mjcf.FOLDER / robot).is_file()  # before a file of the same name here
        return robot if ours else str(Path(robot).absolute())
    try:
        menagerie = import_module("mujoco_menagerie")
        found, cache = menagerie.get(robot), menagerie.Cache()
        if cache.root is not None or cache.is_cached(found):
            return str(found.xml(found.default_model))
        line = f"is not on this machine; download it by `mujoco-menagerie prefetch {robot}`"
    except (ImportError, LookupError) as error:
        line = f"{error}; give a file, or a robot of MuJoCo Menagerie ({install('menagerie')})"
    raise UsageError(f"env.robot={robot}: {line}")


@cache
def simplified(robot: str, free: bool) -> str:
    """MJCF text of a robot; free: whether its base is, else it is fixed to the world."""
    spec = mjcf.spec(located(robot))
    for geom in spec.geoms:
        if geom.parent == spec.worldbody:
            spec.delete(geom)
        elif geom.type == MESH and geom.contype | geom.conaffinity:
            geom.type = CAPSULE  # fitted to the mesh
    spec.worldbody.add_geom(name="floor", type=PLANE, size=[0, 0, 1], material="", contype=1)
    model = spec.compile()
    joints = model.actuator_trntype == JOINT
    if (FREE in model.jnt_type[:1]) != free or not joints.any():
        base = "a free base, <freejoint/>," if free else "a fixed base"
        raise UsageError(f"env.robot={robot}: must have {base} and motors of joints")
    data, feet = _home(model), np.zeros(model.ngeom, bool)
    if free:
        high = [mujoco.mj_geomDistance(model, data, 0, i, 1e3, None) for i in range(model.ngeom)]
        low = np.where(model.geom_contype | model.geom_conaffinity, high, np.inf)[1:]
        feet[1:] = low < low.min() + LEVEL
        data.qpos[2] -= low.min()
    data.ctrl[joints] = data.qpos[model.jnt_qposadr[model.actuator_trnid[joints, 0]]]
    for actuator in np.array(spec.actuators)[joints & (model.actuator_biasprm[:, 1] == 0)]:
        _serve(spec, model, actuator)
    for body in spec.bodies[1:]:
        body.explicitinertial, body.mass = True, model.body_mass[body.id]
        body.ipos, body.iquat = model.body_ipos[body.id], model.body_iquat[body.id]
        body.inertia, body.fullinertia = model.body_inertia[body.id], np.full(6, np.nan)
    for i, geom in list(enumerate(spec.geoms))[1:]:
        _draw(spec, model, geom, i, bool(feet[i]))
    for material in spec.materials:
        material.textures = [""] * len(material.textures)
    for element in [*spec.meshes, *spec.textures, *spec.sensors, *spec.keys, *spec.pairs]:
        spec.delete(element)
    _set_scene(spec, model.stat.extent)
    spec.add_key(name="home", qpos=data.qpos, ctrl=data.ctrl)
    spec.compile()
    return spec.to_xml()


def _home(model: mujoco.MjModel) -> mujoco.MjData:
    """The robot at home, with the poses of its bodies."""
    data = mujoco.MjData(model)
    if model.nkey:
        named = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_KEY, "home")
        mujoco.mj_resetDataKeyframe(model, data, max(named, 0))
    else:
        at, (low, high) = model.jnt_qposadr, model.jnt_range.T
        outside = model.jnt_limited & ((data.qpos[at] < low) | (data.qpos[at] > high))
        data.qpos[at] = np.where(outside, (low + high) / 2, data.qpos[at])
    mujoco.mj_kinematics(model, data)
    return data


def _serve(spec: mujoco.MjSpec, model: mujoco.MjModel, actuator: mujoco.MjsActuator) -> None:
    """Make a position servo of an actuator that moves a joint by its torque."""
    i = actuator.id
    joint, gear = model.actuator_trnid[i, 0], abs(model.actuator_gear[i, 0])
    torque = gear * abs(model.actuator_gainprm[i, 0])  # at control 1: the most without limits
    ranges = [torque * model.actuator_ctrlrange[i, 1], gear * model.actuator_forcerange[i, 1]]
    ranges += [model.jnt_actfrcrange[joint, 1]]
    most = min((each for each in ranges if each > 0), default=torque)
    actuator.set_to_position(kp=most / OFFSET)
    actuator.gear, actuator.forcerange, actuator.forcelimited = [1, 0, 0, 0, 0, 0], [-most, most], 1
    actuator.ctrlrange, actuator.ctrllimited = model.jnt_range[joint], model.jnt_limited[joint]
    own = -model.actuator_biasprm[i, 2] * gear**2
    spec.joints[joint].damping[0] += max(DAMPING * most / OFFSET, own)


def _draw(
    spec: mujoco.MjSpec, model: mujoco.MjModel, geom: mujoco.MjsGeom, i: int, foot: bool
) -> None:
    """Leave geom i as a picture, which touches the floor if it is a foot; meshes go."""
    if geom.type == MESH:
        spec.delete(geom)
        return
    geom.meshname, geom.fromto = "", np.full(6, np.nan)
    geom.pos, geom.quat, geom.size = model.geom_pos[i], model.geom_quat[i], model.geom_size[i]
    geom.contype, geom.conaffinity, geom.group = 0, int(foot), 0
    if foot:
        geom.condim, geom.priority = 3, 1


def _set_scene(spec: mujoco.MjSpec, extent: float) -> None:
    """A chequered floor, a camera, and options with which all implementations agree on feet."""
    kinds = {"type": mujoco.mjtTexture.mjTEXTURE_2D, "builtin": mujoco.mjtBuiltin.mjBUILTIN_CHECKER}
    colours = {"rgb1": [0.36, 0.42, 0.48], "rgb2": [0.44, 0.5, 0.56]}
    spec.add_texture(name="floor", width=300, height=300, **kinds, **colours)
    paint = spec.material("floor") or spec.add_material(name="floor")
    paint.texuniform, paint.texrepeat = True, [1, 1]
    paint.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "floor"
    floor = spec.geom("floor")  # white: its texture's colours, whatever those of the file's default
    floor.material, floor.rgba, floor.contype, floor.conaffinity = "floor", np.ones(4), 1, 0
    if CAMERA not in [camera.name for camera in spec.cameras]:
        mode, away = mujoco.mjtCamLight.mjCAMLIGHT_TRACKCOM, extent * np.array([0, -2.5, 0.875])
        spec.bodies[1].add_camera(name=CAMERA, mode=mode, pos=away, quat=[0.81, 0.59, 0, 0])
    option = spec.option
    option.timestep, option.cone, option.impratio = TIMESTEP, mujoco.mjtCone.mjCONE_PYRAMIDAL, 1
    option.iterations, option.ls_iterations = 8, 16
