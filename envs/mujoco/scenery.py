"""What is drawn of an environment: its `scene` at its `pose`, else the model that it simulates.

A model without a sky, a light or a camera of the name CAMERA gets ours: a gradient, a brighter
headlight, and a free camera that follows its first body.
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
AMBIENT = 0.35  # of the headlight, instead of MuJoCo's 0.1
ELEVATION = -15.0  # [degrees] of the free camera, instead of MuJoCo's -45
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
    scene_of(env)
    pose_of(env)


def _first(env: Any) -> PhysicsState:
    """The shapes of the simulation's state in `env`."""
    found = simulated(jax.eval_shape(env.reset, jax.random.key(0)))
    if not found:
        line = f"{type(env).__name__} has no `scene` and no `pose`: the world cannot be drawn"
        raise UsageError(f"{line}; {DRAWN}")
    return found[0]


def simulated(state: EnvState) -> list[PhysicsState]:
    """The states of MuJoCo's models in the state of an environment."""
    leaves = jax.tree.leaves(state.data, is_leaf=lambda x: isinstance(x, PhysicsState))
    return [x for x in leaves if isinstance(x, PhysicsState)]


def dressed(scene: str) -> mujoco.MjModel:
    """The compiled model of `scene`, with a sky and light; scene: MJCF text, or a file."""
    spec = mjcf.spec(scene)
    if all(texture.type != mujoco.mjtTexture.mjTEXTURE_SKYBOX for texture in spec.textures):
        sky = spec.add_texture(type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=256, height=1536)
        sky.builtin = mujoco.mjtBuiltin.mjBUILTIN_GRADIENT
        sky.rgb1, sky.rgb2 = SKY
    if not spec.lights:
        spec.visual.headlight.ambient = np.maximum(spec.visual.headlight.ambient, AMBIENT)
    return spec.compile()


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
        found.elevation = ELEVATION
    return found
