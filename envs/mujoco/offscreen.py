"""Pictures of a MuJoCo scene, drawn without a display.

The backend is chosen at the first drawing, by a trial in a process of its own: EGL
(graphics cards, and software rendering by Mesa), else OSMesa. MUJOCO_GL=egl or
osmesa in the environment decides instead. MuJoCo's own Renderer is not used, since
it is bound to whatever MUJOCO_GL was when mujoco was first imported, and without a
display a failure of its default backend ends the process.
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
CAMERA = "track"  # taken where a scene has one of this name
SHADOWS = 1024  # [pixels] of the shadow map; 4096 triples the time without a graphics card
SURE = 1024  # [pixels] a side that OpenGL guarantees; a larger one is tried first
DRAWN = ("scene", "pose")  # what a world that can be drawn has
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
    """Nothing here can draw without a display; one line says what to install."""


@cache
def backend() -> str:
    """The first of BACKENDS that draws here, or what MUJOCO_GL names.

    Raises:
        NoGraphicsError: where none does.
    """
    if sys.platform == "darwin":
        return "cgl"
    wish = os.environ.get("MUJOCO_GL", "").strip().lower()
    tried = (wish,) if wish in BACKENDS else BACKENDS
    for name in tried:
        if _trial(name, 8, 8).returncode == 0:
            return name
    raise NoGraphicsError(
        f"cannot draw without a display: {' and '.join(tried)} failed; "
        "install libegl1 or libosmesa6 (Debian: apt-get install libegl1 libosmesa6)"
    )


def check_size(width: int, height: int) -> None:
    """Raise ValueError for a picture that the backend has no framebuffer for.

    width, height: [pixels].
    """
    if max(width, height) <= SURE:
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
    """The process that drew, or failed to draw, with one backend; it prints the longest side."""
    clean = {key: value for key, value in os.environ.items() if key != "PYOPENGL_PLATFORM"}
    code = TRIAL.format(backend=name, width=width, height=height)
    run = [sys.executable, "-c", code]
    return subprocess.run(run, env={**clean, "MUJOCO_GL": name}, capture_output=True, text=True)


def check_drawable(world: Any) -> None:
    """Raise ValueError for a world without `scene` and `pose`, which a picture needs."""
    missing = [f"`{name}`" for name in DRAWN if not hasattr(world, name)]
    if missing:
        raise ValueError(
            f"{type(world).__name__} has no {' and no '.join(missing)}: the world cannot be drawn"
        )


class Canvas:
    """A scene, drawn one picture at a time; `close()` frees it, as does the end of the process.

    scene: MJCF text. width, height: [pixels].

    Raises:
        NoGraphicsError: where nothing here can draw.
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
        self.close.atexit = False  # but before EGL, which registered earlier, ends
        atexit.register(self.close)

    def draw(self, qpos: np.ndarray) -> np.ndarray:
        """The picture [height, width, 3] (uint8) of positions qpos [nq].

        Raises:
            ValueError: for positions of another size.
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
    """The scene's own that follows the robot, else a free one that follows its first body."""
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
