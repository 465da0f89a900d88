"""Rendering of a MuJoCo scene without a display.

The first rendering chooses the backend by a trial in a separate process: EGL (graphics cards, and
software rendering by Mesa), else OSMesa. The environment variable MUJOCO_GL=egl or osmesa
overrides the choice. MuJoCo's own Renderer is not used because it is bound to the value of
MUJOCO_GL at the first import of mujoco, and because without a display a failure of its default
backend ends the process.
"""

import atexit
import contextlib
import importlib
import os
import subprocess
import sys
import weakref
from functools import cache
from typing import Any

import mujoco
import numpy as np

BACKENDS = ("egl", "osmesa")
CAMERA = "track"  # used if the scene has a camera of this name
SHADOWS = 1024  # [pixels] of the shadow map; 4096 takes three times as long in software
GUARANTEED = 1024  # [pixels] per side in any OpenGL; larger sizes are tested first
METHODS = ("scene", "pose")  # of an environment that can be rendered
TRIAL = """
import mujoco
from mujoco.{backend} import GLContext
window = GLContext(8, 8)
window.make_current()
try:
    from OpenGL import GL
    print(int(GL.glGetIntegerv(GL.GL_MAX_RENDERBUFFER_SIZE)), flush=True)
except ImportError:
    pass
model = mujoco.MjModel.from_xml_string("<mujoco/>")
model.vis.global_.offwidth, model.vis.global_.offheight = {width}, {height}
context = mujoco.MjrContext(model, 150)
context.free()
window.free()
"""


class NoGraphicsError(OSError):
    """No backend can render without a display; the message names what to install."""


@cache
def backend() -> str:
    """The first of BACKENDS that works on this machine, or the one that MUJOCO_GL names.

    Raises:
        NoGraphicsError: if none works.
    """
    if sys.platform == "darwin":
        return "cgl"
    requested = os.environ.get("MUJOCO_GL", "").strip().lower()
    tried = (requested,) if requested in BACKENDS else BACKENDS
    for name in tried:
        if _trial(name, 8, 8).returncode == 0:
            return name
    raise NoGraphicsError(
        f"cannot draw without a display: {' and '.join(tried)} failed; "
        "install libegl1 or libosmesa6 (Debian: apt-get install libegl1 libosmesa6)"
    )


def check_size(width: int, height: int) -> None:
    """Raise ValueError for an image larger than the backend's largest framebuffer.

    width, height: [pixels].
    """
    if max(width, height) <= GUARANTEED:
        return
    done = _trial(backend(), width, height)
    if done.returncode == 0:
        return
    most = int(done.stdout.split()[0]) if done.stdout else max(width, height)
    for name, value in (("width", width), ("height", height)):
        if value > most:
            raise ValueError(f"{name}={value}: must be at most {most}, the limit of OpenGL here")
    raise ValueError(f"width={width}, height={height}: too large for OpenGL here")


def _trial(name: str, width: int, height: int) -> Any:
    """The finished process of a trial with one backend; it prints the largest side [pixels]."""
    clean = {key: value for key, value in os.environ.items() if key != "PYOPENGL_PLATFORM"}
    code = TRIAL.format(backend=name, width=width, height=height)
    run = [sys.executable, "-c", code]
    return subprocess.run(run, env={**clean, "MUJOCO_GL": name}, capture_output=True, text=True)


def check_drawable(env: Any) -> None:
    """Raise ValueError for an environment without `scene` and `pose`, which rendering needs."""
    missing = [f"`{name}`" for name in METHODS if not hasattr(env, name)]
    if missing:
        raise ValueError(
            f"{type(env).__name__} has no {' and no '.join(missing)}: the world cannot be drawn"
        )


class Canvas:
    """Renders images of one scene; `close()`, or the end of the process, frees its resources.

    scene: MJCF text. width, height: [pixels].

    Raises:
        NoGraphicsError: if no backend works on this machine.
    """

    def __init__(self, scene: str, width: int = 640, height: int = 480) -> None:
        name = backend()
        if name in BACKENDS:
            os.environ["PYOPENGL_PLATFORM"] = name
        self.model = mujoco.MjModel.from_xml_string(scene)
        self.model.vis.global_.offwidth, self.model.vis.global_.offheight = width, height
        self.model.vis.quality.shadowsize = SHADOWS
        self._data, self._camera = mujoco.MjData(self.model), _camera(self.model)
        self._view = mujoco.MjrRect(0, 0, width, height)
        self._scenery = mujoco.MjvScene(self.model, maxgeom=10_000)
        self._scenery.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = False
        self._window: Any = importlib.import_module(f"mujoco.{name}").GLContext(width, height)
        with contextlib.ExitStack() as parts:
            parts.callback(self._window.free)
            self._window.make_current()
            self._context = mujoco.MjrContext(self.model, mujoco.mjtFontScale.mjFONTSCALE_150)
            parts.callback(self._context.free)
            parts.callback(self._window.make_current)  # OpenGL frees in the current window
            self.close = weakref.finalize(self, parts.pop_all().close)
        self.close.atexit = False  # but before EGL ends, which registered earlier
        atexit.register(self.close)

    def draw(self, qpos: np.ndarray) -> np.ndarray:
        """The image [height, width, 3] (uint8) at joint positions qpos [nq].

        Raises:
            ValueError: for a qpos of another size.
        """
        if np.shape(qpos) != (self.model.nq,):
            raise ValueError(f"qpos is {np.shape(qpos)}; the scene takes [{self.model.nq}]")
        self._window.make_current()
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        self._data.qpos[:] = qpos
        mujoco.mj_forward(self.model, self._data)
        every, option = mujoco.mjtCatBit.mjCAT_ALL, mujoco.MjvOption()
        mujoco.mjv_updateScene(
            self.model, self._data, option, None, self._camera, every, self._scenery
        )
        mujoco.mjr_render(self._view, self._scenery, self._context)
        picture = np.empty((self._view.height, self._view.width, 3), np.uint8)
        mujoco.mjr_readPixels(picture, None, self._view, self._context)
        return picture[::-1].copy()  # OpenGL counts rows from below


def _camera(model: mujoco.MjModel) -> mujoco.MjvCamera:
    """The scene's camera that follows the robot, else a free one that follows the first body."""
    camera = mujoco.MjvCamera()
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, CAMERA)
    if number >= 0:
        camera.type, camera.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, number
    else:
        mujoco.mjv_defaultFreeCamera(model, camera)
        camera.type, camera.trackbodyid = (
            mujoco.mjtCamera.mjCAMERA_TRACKING,
            min(1, model.nbody - 1),
        )
    return camera
