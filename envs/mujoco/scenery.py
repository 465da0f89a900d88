"""What is drawn of an environment: its `scene` at its `pose`, else the model that it simulates.

A model without a sky, a light or a camera of the name CAMERA gets ours: a gradient; a lamp above
it, with colours for what is in MuJoCo's grey; and a free camera that follows its first body, so
near that what moves fills the picture.
"""

from collections.abc import Callable
from typing import Any

import jax
import mujoco
import numpy as np
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.errors import UsageError
from hybrid_rl.types import EnvState

CAMERA = "track"  # used if the scene has a camera of this name
SKY = ((0.65, 0.78, 0.92), (0.96, 0.97, 0.98))  # above, and at the horizon
GREY = (0.5, 0.5, 0.5, 1.0)  # of a geom whose author chose no colour
ROBOT, GROUND = (0.91, 0.62, 0.24, 1.0), (0.40, 0.46, 0.52, 1.0)  # instead of it
LAMP = (0.0, 0.45, -1.0)  # direction of its light
ELEVATION = -15.0  # [degrees] of the free camera, instead of MuJoCo's -45
MARGIN = 1.1  # of the free camera's distance
DRAWN = "write `scene(self)`, MJCF text or its file, and `pose(self, state)`, its qpos at a state"


def scene_of(env: Any) -> str:
    """The name of the model that is drawn, for `mjcf.spec`: its MJCF text, or its file."""
    scene = getattr(env, "scene", None)
    return _first(env).asset if scene is None else scene()


def pose_of(env: Any) -> Callable[[EnvState], Array]:
    """The function from a state to the positions [nq] that are drawn."""
    if (pose := getattr(env, "pose", None)) is not None:
        return pose
    _first(env)
    return lambda state: simulated(state)[0].qpos


def check_drawable(env: Any) -> None:
    """Raise UsageError for an environment that cannot be drawn."""
    try:
        scene_of(env)
        pose_of(env)
    except ValueError as error:
        raise UsageError(str(error)) from error


def _first(env: Any) -> PhysicsState:
    """The shapes of the simulation's state in `env`."""
    found = simulated(jax.eval_shape(env.reset, jax.random.key(0)))
    if not found:
        line = f"{type(env).__name__} has no `scene` and no `pose`: the world cannot be drawn"
        raise ValueError(f"{line}; {DRAWN}")
    return found[0]


def simulated(state: EnvState) -> list[PhysicsState]:
    """The states of MuJoCo's models in the state of an environment."""

    def is_one(x: Any) -> bool:
        return isinstance(x, PhysicsState)

    return [x for x in jax.tree.leaves(state.data, is_leaf=is_one) if is_one(x)]


def dressed(scene: str) -> mujoco.MjModel:
    """The compiled model of `scene`, with a sky and light; scene: MJCF text, or a file."""
    spec = mjcf.spec(scene)
    if all(texture.type != mujoco.mjtTexture.mjTEXTURE_SKYBOX for texture in spec.textures):
        sky = spec.add_texture(type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=256, height=1536)
        sky.builtin = mujoco.mjtBuiltin.mjBUILTIN_GRADIENT
        sky.rgb1, sky.rgb2 = SKY
    if spec.lights:
        return spec.compile()
    centre, size = _robot(spec.compile())
    lamp = spec.worldbody.add_light(type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL, dir=LAMP)
    lamp.pos = centre - 4 * size * np.array(LAMP)
    lamp.diffuse, lamp.specular = [0.55] * 3, [0.0] * 3
    head = spec.visual.headlight
    head.ambient = np.maximum(head.ambient, 0.35)
    model = spec.compile()
    plain = (model.geom_matid < 0) & (model.geom_rgba == np.array(GREY, np.float32)).all(1)
    model.geom_rgba[plain] = np.where(_moves(model)[plain, None], ROBOT, GROUND)
    return model


def camera(model: mujoco.MjModel) -> mujoco.MjvCamera:
    """The scene's camera that follows the robot, else a free one that follows the first body."""
    found = mujoco.MjvCamera()
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, CAMERA)
    if number >= 0:
        found.type, found.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, number
        return found
    mujoco.mjv_defaultFreeCamera(model, found)
    if model.nbody > 1:
        found.type, found.trackbodyid = mujoco.mjtCamera.mjCAMERA_TRACKING, 1
        found.distance = MARGIN * _robot(model)[1] / np.sin(np.radians(model.vis.global_.fovy / 2))
        found.elevation = max(found.elevation, ELEVATION)
    return found


def _moves(model: mujoco.MjModel) -> np.ndarray:
    """Whether [ngeom] each geom belongs to a body that can move."""
    return model.body_weldid[model.geom_bodyid] > 0


def _robot(model: mujoco.MjModel) -> tuple[np.ndarray, float]:
    """Centre of mass [3] of the first body, and radius of all that moves about it."""
    data, moves = mujoco.MjData(model), _moves(model)
    if not moves.any():
        return model.stat.center, model.stat.extent
    mujoco.mj_fwdPosition(model, data)
    centre = data.subtree_com[1]
    away = np.linalg.norm(data.geom_xpos[moves] - centre, axis=1) + model.geom_rbound[moves]
    return centre, float(away.max())
